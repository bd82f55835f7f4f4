"""Bend a strip over a cylinder, release it, and look at the force and at the shape."""

import umform as uf

strip = uf.mesh.strip(length=60, width=10, thickness=1, cells=(24, 1))
steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(yield_stress=160, modulus=500))
model = uf.Model(strip, element="ANS3DEAS", material=steel, thickness_points=5)
model.symmetry("x0", normal="x")
model.fix([0], "y")
punch = model.prescribe("x0_lower", "z", name="punch")
cylinder = uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20)
model.contact("lower", cylinder, penalty=100, points=5, name="cylinder")

result = uf.solve(model, [uf.Move(punch, to=-15, steps=300), uf.Release(punch)])

result.plot("punch", "punch_force", "bending.png")
result.write("bending.vtkhdf")
result.report("bending.html")
