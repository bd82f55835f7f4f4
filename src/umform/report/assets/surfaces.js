// Surfaces as geometries: outer faces of elements, and triangles of tools and solids.

function emptyGeometry(count) {
  const geometry = new THREE.BufferGeometry();
  for (const [name, size] of [["position", 3], ["normal", 3], ["value", 1]]) {
    geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * count), size));
  }
  return geometry;
}

// Outer faces of elements, subdivided: products of the matrices of umform.report.patches and nodal values.
class Patches {
  constructor({ head, arrays }) {
    let [begun, faces, groups] = [0, 0, 0];
    this.kinds = head.patches.map(({ points: [a, b], grid: [r, c], inner }, number) => {
      const of = (name) => arrays[`patches ${number} ${name}`];
      const kind = { a, b, n: r * c, inner, start: begun, first: faces, nodes: of("nodes"), groups: of("groups"), owners: of("owners") };
      for (const name of ["position", "rows", "columns", "middle", "corners"]) kind[name] = of(name);
      Object.assign(kind, { points: a * b, count: kind.nodes.length / kind.n, cross: new Float32Array(3 * a * b * kind.owners.length) });
      kind.cornerNodes = [0, c - 1, r * c - 1, (r - 1) * c];
      kind.cornerPoints = [0, b - 1, a * b - 1, (a - 1) * b];
      begun += kind.points * kind.count;
      faces += kind.count;
      groups = kind.groups.reduce((most, one) => Math.max(most, one + 1), groups);
      return kind;
    });
    this.count = faces;
    this.sums = new Float32Array(3 * groups);
    this.seams = head.mirrors.map(({ axis }, number) => ({ axis, groups: arrays[`seam ${number}`] }));
    this.geometry = emptyGeometry(begun);
    const index = [];
    for (const { a, b, start, points, count } of this.kinds) {
      for (let f = 0; f < count; f += 1) {
        for (let i = 0; i < a - 1; i += 1) {
          for (let j = 0; j < b - 1; j += 1) {
            const at = start + f * points + i * b + j;
            index.push(at, at + 1, at + b + 1, at, at + b + 1, at + b);
          }
        }
      }
    }
    this.geometry.setIndex(index);
    this.inside = this.kinds.reduce((sum, { a, b, inner }) => sum + 6 * (a - 1) * (b - 1) * inner, 0);
    this.edges = head.lines.map((size, number) => ({ size, points: arrays[`lines ${number}`] }));
  }

  // Faces in planes of symmetry are the last; they are inside the whole part.
  whole(on) {
    this.geometry.setDrawRange(0, this.geometry.index.count - (on ? this.inside : 0));
  }

  // Edges of the elements, each once, on the same positions.
  lines() {
    const index = [];
    for (const { size, points } of this.edges) {
      for (let k = 0; k < points.length; k += 1) if ((k + 1) % size) index.push(points[k], points[k + 1]);
    }
    const geometry = new THREE.BufferGeometry();
    for (const name of ["position", "normal", "value"]) geometry.setAttribute(name, this.geometry.getAttribute(name));
    geometry.setIndex(index);
    return geometry;
  }

  // Sum over the nodes of a face: a row of a matrix times their vectors.
  static product(kind, matrix, row, face, nodal, into) {
    into.fill(0);
    for (let k = 0; k < kind.n; k += 1) {
      const weight = matrix[row * kind.n + k];
      const node = 3 * kind.nodes[face * kind.n + k];
      for (let i = 0; i < 3; i += 1) into[i] += weight * nodal[node + i];
    }
  }

  move(nodal) {
    const [position, normal] = ["position", "normal"].map((name) => this.geometry.getAttribute(name));
    const [x, u, v] = [0, 0, 0].map(() => new Float64Array(3));
    this.sums.fill(0);
    for (const kind of this.kinds) {
      for (let f = 0; f < kind.count; f += 1) {
        for (let p = 0; p < kind.points; p += 1) {
          const at = 3 * (f * kind.points + p);
          Patches.product(kind, kind.position, p, f, nodal, x);
          Patches.product(kind, kind.rows, p, f, nodal, u);
          Patches.product(kind, kind.columns, p, f, nodal, v);
          position.array.set(x, 3 * kind.start + at);
          for (let i = 0; i < 3; i += 1) {
            const [j, k] = [(i + 1) % 3, (i + 2) % 3];
            kind.cross[at + i] = v[j] * u[k] - v[k] * u[j];
          }
        }
        kind.cornerPoints.forEach((p, k) => {
          const [at, group] = [3 * (f * kind.points + p), 3 * kind.groups[4 * f + k]];
          for (let i = 0; i < 3; i += 1) this.sums[group + i] += kind.cross[at + i];
        });
      }
    }
    for (const { axis, groups } of this.seams) for (const group of groups) this.sums[3 * group + axis] = 0;
    for (let group = 0; group < this.sums.length; group += 3) shorten(this.sums, group);
    for (const kind of this.kinds) this.turn(kind, normal.array);
    position.needsUpdate = normal.needsUpdate = true;
    this.geometry.boundingSphere = null;
  }

  // Normals of a kind: those of the shape functions, and the correction at the corners, spread bilinearly.
  turn(kind, normals) {
    const change = new Float64Array(12);
    for (let at = 0; at < kind.cross.length; at += 3) shorten(kind.cross, at);
    for (let f = 0; f < kind.count; f += 1) {
      kind.cornerPoints.forEach((p, k) => {
        for (let i = 0; i < 3; i += 1) {
          change[3 * k + i] = this.sums[3 * kind.groups[4 * f + k] + i] - kind.cross[3 * (f * kind.points + p) + i];
        }
      });
      for (let p = 0; p < kind.points; p += 1) {
        const at = 3 * (f * kind.points + p);
        for (let i = 0; i < 3; i += 1) {
          let sum = kind.cross[at + i];
          for (let k = 0; k < 4; k += 1) sum += kind.corners[4 * p + k] * change[3 * k + i];
          normals[3 * kind.start + at + i] = sum;
        }
        shorten(normals, 3 * kind.start + at);
      }
    }
  }

  // A field by the shape functions, or bilinear between the corners.
  colour(values, { on }) {
    const value = this.geometry.getAttribute("value");
    for (const { nodes, n, points, count, start, position, corners, cornerNodes } of this.kinds) {
      const [matrix, at] = on === "corners" ? [corners, cornerNodes] : [position, [...Array(n).keys()]];
      for (let f = 0; f < count; f += 1) {
        for (let p = 0; p < points; p += 1) {
          let sum = 0;
          at.forEach((node, k) => { sum += matrix[at.length * p + k] * values[nodes[f * n + node]]; });
          value.array[start + f * points + p] = sum;
        }
      }
    }
    value.needsUpdate = true;
  }

  // Middle, unit normal, size and element of each face.
  middles(nodal, take) {
    const [x, u, v] = [0, 0, 0].map(() => new THREE.Vector3());
    const three = [0, 0, 0];
    for (const kind of this.kinds) {
      for (let f = 0; f < kind.count; f += 1) {
        [x, u, v].forEach((one, row) => {
          Patches.product(kind, kind.middle, row, f, nodal, three);
          one.fromArray(three);
        });
        const normal = v.clone().cross(u);
        const size = Math.sqrt(4 * normal.length());
        take(kind.first + f, x, normal.normalize(), size, kind.owners[f]);
      }
    }
  }
}

// Three numbers of an array, made a unit vector; zero remains zero.
function shorten(array, at) {
  const size = Math.hypot(array[at], array[at + 1], array[at + 2]);
  if (size > 0) for (let i = 0; i < 3; i += 1) array[at + i] /= size;
}

// Triangles. Corners do not share their values, but corners of one group share their normal.
class Triangles {
  constructor(faces, groups, owners) {
    Object.assign(this, { faces, groups, owners, count: faces.length / 3 });
    this.sums = new Float32Array(3 * (groups.reduce((a, b) => Math.max(a, b), -1) + 1));
    this.geometry = emptyGeometry(faces.length);
    this.geometry.setIndex([...faces.keys()]);
  }

  whole() {}

  lines() {
    return new THREE.EdgesGeometry(this.geometry, 25);
  }

  move(points) {
    const position = this.geometry.getAttribute("position");
    this.faces.forEach((node, corner) => {
      position.array.set(points.subarray(3 * node, 3 * node + 3), 3 * corner);
    });
    position.needsUpdate = true;
    this.geometry.boundingSphere = null;
    this.turnNormals(points);
  }

  // Normals: areas of the faces of each group, added up.
  turnNormals(points) {
    const { faces, groups, sums } = this;
    const normal = this.geometry.getAttribute("normal");
    sums.fill(0);
    for (let f = 0; f < this.count; f += 1) {
      const [a, b, c] = [0, 1, 2].map((i) => 3 * faces[f * 3 + i]);
      const u = [0, 1, 2].map((i) => points[b + i] - points[a + i]);
      const v = [0, 1, 2].map((i) => points[c + i] - points[a + i]);
      for (let i = 0; i < 3; i += 1) {
        const [p, q] = [(i + 1) % 3, (i + 2) % 3];
        const area = u[p] * v[q] - u[q] * v[p];
        for (let corner = f * 3; corner < f * 3 + 3; corner += 1) sums[3 * groups[corner] + i] += area;
      }
    }
    groups.forEach((group, corner) => {
      normal.array.set(sums.subarray(3 * group, 3 * group + 3), 3 * corner);
    });
    normal.needsUpdate = true;
  }

  // Values of the faces.
  colour(values) {
    const value = this.geometry.getAttribute("value");
    for (let corner = 0; corner < this.faces.length; corner += 1) {
      value.array[corner] = values[this.owners[Math.floor(corner / 3)]];
    }
    value.needsUpdate = true;
  }
}
