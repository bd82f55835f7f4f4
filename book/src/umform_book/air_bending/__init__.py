"""Air bending: sharpness, wide sheets against closed forms, rules of the shop, meshes, smooth curves."""

from umform_book.air_bending import mesh_study, sharpness, shop_formulas, smoothness, wide_sheet
from umform_book.case import Chapter

CHAPTER = Chapter(
    "Air bending",
    "The press brake of `umform bend`: sharp bends, closed forms, workshop formulas, meshes, smooth curves.",
    (sharpness.CASE, wide_sheet.CASE, shop_formulas.CASE, mesh_study.CASE, smoothness.CASE),
)
