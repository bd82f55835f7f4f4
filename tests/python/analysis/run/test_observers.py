"""Somebody who looks at a run between its increments sees all of them, and changes none."""

import umform as uf
from umform.analysis.run.observers import watching


def run():
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", name="tip")
    return uf.solve(model, uf.Move(tip, to=-0.1, steps=5), progress=False)


def test_watcher_sees_all_increments_and_changes_none():
    seen = []
    with watching(lambda run: seen.append(len(run.result))):
        watched = run()
    assert seen == [1, 2, 3, 4, 5, 6]
    assert watched["tip_force"].tolist() == run()["tip_force"].tolist()
    assert len(seen) == 6  # nobody looks any more
