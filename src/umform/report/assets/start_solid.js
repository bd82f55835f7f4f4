// The view of a solid alone: no history, no curves, no lines of a mesh.

async function start() {
  window.umform = { curves: { text: () => "" } };
  element("shape-lines").checked = false;
  try {
    await started("three");
    const scene = await unpacked(element("scene").textContent);
    element("shape").hidden = false;
    element("shape").closest(".either").classList.add("alive");
    window.umform.shape = new ShapeView(scene);
  } catch (problem) {
    element("shape").hidden = true;
    element("shape-problem").hidden = false;
    element("shape-problem").append(` (${problem.message})`);
  }
  document.documentElement.dataset.ready = "yes";
}

start();
