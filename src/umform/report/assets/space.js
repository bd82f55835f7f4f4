// Surfaces in space: the sheet, which deforms, and the tools, which move.

const VERTEX = `
  in vec3 position; in vec3 normal; in float value;
  uniform mat4 modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix;
  out vec3 vNormal; out float vValue;
  void main() {
    vNormal = normalMatrix * normal;
    vValue = value;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

// A lamp to the upper left of the observer, and light from everywhere.
const FRAGMENT = `
  precision highp float;
  in vec3 vNormal; in float vValue;
  uniform sampler2D map; uniform vec2 range; uniform vec3 colour; uniform float opacity; uniform bool mapped;
  out vec4 result;
  void main() {
    vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);
    float lamp = max(dot(n, normalize(vec3(-0.35, 0.55, 0.8))), 0.0);
    float t = clamp((vValue - range.x) / (range.y - range.x), 0.0, 1.0);
    vec3 own = mapped ? texture(map, vec2(t * 63.0 / 64.0 + 0.5 / 64.0, 0.5)).rgb : colour;
    result = vec4(own * (0.62 + 0.42 * lamp), opacity);
  }`;

// Products of mirrors at some planes, as groups that hold the images of a body; the body itself is not among them.
function images(mirrors, body) {
  return Array.from({ length: 2 ** mirrors.length - 1 }, (_, n) => {
    const rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]];
    mirrors.forEach(({ axis, at }, bit) => {
      if (((n + 1) >> bit) & 1) Object.assign(rows[axis], { [axis]: -1, 3: 2 * at });
    });
    const group = new THREE.Group();
    group.matrixAutoUpdate = false;
    group.matrix.set(...rows.flat(), 0, 0, 0, 1);
    group.matrixWorldNeedsUpdate = true;
    group.add(body());
    return group;
  });
}

function material(options, uniforms) {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide, ...options,
    uniforms: {
      map: { value: null }, range: { value: new THREE.Vector2(0, 1) }, colour: { value: new THREE.Color() },
      opacity: { value: 1 }, mapped: { value: false }, ...uniforms,
    },
  });
}

// Faces with k corners each. Corners do not share their values, but corners of one group share their normal.
class Faces {
  constructor(faces, groups, k) {
    Object.assign(this, { faces, groups, k, count: faces.length / k });
    this.sums = new Float32Array(3 * (groups.reduce((a, b) => Math.max(a, b), -1) + 1));
    this.geometry = new THREE.BufferGeometry();
    for (const [name, size] of [["position", 3], ["normal", 3], ["value", 1]]) {
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(size * faces.length), size));
    }
    const index = [];
    for (let f = 0; f < this.count; f += 1) {
      for (let i = 2; i < k; i += 1) index.push(f * k, f * k + i - 1, f * k + i);
    }
    this.geometry.setIndex(index);
  }

  // Edges of the faces, each once, on the same positions.
  lines() {
    const seen = new Set();
    const index = [];
    for (let c = 0; c < this.faces.length; c += 1) {
      const d = (c + 1) % this.k ? c + 1 : c + 1 - this.k;
      const [a, b] = [this.faces[c], this.faces[d]];
      const key = Math.min(a, b) * 4294967296 + Math.max(a, b);
      if (!seen.has(key)) index.push(c, d);
      seen.add(key);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.geometry.getAttribute("position"));
    geometry.setIndex(index);
    return geometry;
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
    const { faces, groups, k, sums } = this;
    const normal = this.geometry.getAttribute("normal");
    sums.fill(0);
    for (let f = 0; f < this.count; f += 1) {
      const [a, b, c, d] = [0, 1, 2, k - 1].map((i) => 3 * faces[f * k + i]);
      const u = [0, 1, 2].map((i) => points[c + i] - points[a + i]);
      const v = [0, 1, 2].map((i) => points[d + i] - points[b + i]);
      for (let i = 0; i < 3; i += 1) {
        const [p, q] = [(i + 1) % 3, (i + 2) % 3];
        const area = u[p] * v[q] - u[q] * v[p];
        for (let corner = f * k; corner < f * k + k; corner += 1) sums[3 * groups[corner] + i] += area;
      }
    }
    groups.forEach((group, corner) => {
      normal.array.set(sums.subarray(3 * group, 3 * group + 3), 3 * corner);
    });
    normal.needsUpdate = true;
  }

  // Values at nodes, or of the cells that own the faces.
  colour(values, owners) {
    const value = this.geometry.getAttribute("value");
    for (let corner = 0; corner < this.faces.length; corner += 1) {
      value.array[corner] = values[owners ? owners[Math.floor(corner / this.k)] : this.faces[corner]];
    }
    value.needsUpdate = true;
  }
}

class Sheet {
  constructor({ head, arrays }) {
    this.arrays = arrays;
    this.fields = head.fields;
    this.faces = new Faces(arrays.faces, arrays.groups, 4);
    this.material = material(
      { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }, { mapped: { value: true } },
    );
    this.mesh = new THREE.Mesh(this.faces.geometry, this.material);
    const ink = new THREE.LineBasicMaterial({ color: 0x87919b, transparent: true, opacity: 0.5 });
    this.lines = new THREE.LineSegments(this.faces.lines(), ink);
    this.axes = this.rollingLines();
    this.mesh.frustumCulled = this.lines.frustumCulled = this.axes.frustumCulled = false;
    const all = [this.mesh, this.lines, this.axes];
    this.images = images(head.mirrors, () => new THREE.Group().add(...all.map((part) => part.clone())));
    this.maps = Object.fromEntries(Object.entries(head.maps).map(([name, hex]) => [name, texture(hex)]));
  }

  // Whether edges are drawn.
  lined(visible) {
    this.lines.visible = visible;
    for (const image of this.images) image.children[0].children[1].visible = visible;
  }

  // Whether the rolling direction is drawn.
  rolled(visible) {
    this.axes.visible = visible;
    for (const image of this.images) image.children[0].children[2].visible = visible;
  }

  // A line for each face.
  rollingLines() {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(6 * this.faces.count), 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0xb3261e }));
  }

  // Lines along the rolling direction through the middles of the faces; none on faces that it stands on.
  turnAxes(frame, points) {
    if (!this.arrays.rolling) return;
    const directions = this.arrays.rolling.at(frame);
    const { faces, count } = this.faces;
    const position = this.axes.geometry.getAttribute("position");
    for (let f = 0; f < count; f += 1) {
      const corners = [0, 1, 2, 3].map((i) => new THREE.Vector3().fromArray(points, 3 * faces[4 * f + i]));
      const middle = corners.reduce((sum, x) => sum.add(x), new THREE.Vector3()).multiplyScalar(0.25);
      const [u, v] = [corners[2].clone().sub(corners[0]), corners[3].clone().sub(corners[1])];
      const normal = u.clone().cross(v).normalize();
      const along = new THREE.Vector3().fromArray(directions, 3 * this.arrays.owners[f]);
      const standing = Math.abs(along.dot(normal)) > 0.5;
      along.addScaledVector(normal, -along.dot(normal)).setLength(standing ? 0 : 0.22 * Math.min(u.length(), v.length()));
      middle.clone().sub(along).toArray(position.array, 6 * f);
      middle.add(along).toArray(position.array, 6 * f + 3);
    }
    position.needsUpdate = true;
  }

  points(frame) {
    return this.arrays.displacements.at(frame).map((shift, i) => this.arrays.points[i] + shift);
  }

  values(field, frame) {
    return this.arrays[`field ${field.name}`].at(frame);
  }

  // Smallest and largest value in a frame, or in all of them without a frame; about zero if the field has two signs.
  range(field, frame) {
    const { codes, size, low, step } = this.arrays[`field ${field.name}`];
    const part = frame === undefined ? codes : codes.subarray(frame * size, (frame + 1) * size);
    const ends = [part.reduce((a, b) => Math.min(a, b)), part.reduce((a, b) => Math.max(a, b))];
    const [bottom, top] = ends.map((code) => low + step * code);
    const size_ = Math.max(-bottom, top);
    return field.symmetric ? [-size_, size_] : [bottom, top];
  }

  show(frame, field, [bottom, top]) {
    const points = this.points(frame);
    this.faces.move(points);
    this.turnAxes(frame, points);
    this.faces.colour(this.values(field, frame), field.on === "cells" && this.arrays.owners);
    const { map, range } = this.material.uniforms;
    map.value = this.maps[field.map];
    range.value.set(bottom, top > bottom ? top : bottom + 1);
  }
}

class ToolBody {
  constructor({ head, arrays }, number) {
    this.poses = arrays[`tool ${number} poses`];
    const faces = new Faces(arrays[`tool ${number} faces`], arrays[`tool ${number} groups`], 3);
    faces.move(arrays[`tool ${number} points`]);
    this.material = material({ transparent: true }, { colour: { value: new THREE.Color(0xa9b4be) } });
    const ink = new THREE.LineBasicMaterial({ color: 0x7f8a94 });
    this.group = new THREE.Group();
    this.group.add(new THREE.Mesh(faces.geometry, this.material));
    this.group.add(new THREE.LineSegments(new THREE.EdgesGeometry(faces.geometry, 25), ink));
    this.group.matrixAutoUpdate = false;
    this.images = images(head.toolMirrors[number].map((plane) => head.mirrors[plane]), () => this.group.clone());
    this.bodies = [this.group, ...this.images.map((image) => image.children[0])];
  }

  place(frame) {
    const pose = this.poses.subarray(12 * frame, 12 * frame + 12);
    for (const body of this.bodies) {
      body.matrix.set(...pose, 0, 0, 0, 1);
      body.matrixWorldNeedsUpdate = true;
    }
  }

  // Seen through, a tool does not hide the sheet behind it.
  look(how) {
    const clear = how === "clear";
    for (const body of this.bodies) body.visible = how !== "hidden";
    this.material.uniforms.opacity.value = clear ? 0.32 : 1;
    this.material.depthWrite = !clear;
  }
}

function texture(hex) {
  const count = hex.length / 6;
  const bytes = new Uint8Array(4 * count).fill(255);
  for (let i = 0; i < count; i += 1) {
    for (let k = 0; k < 3; k += 1) bytes[4 * i + k] = parseInt(hex.substr(6 * i + 2 * k, 2), 16);
  }
  const made = new THREE.DataTexture(bytes, count, 1);
  made.minFilter = made.magFilter = THREE.LinearFilter;
  made.needsUpdate = true;
  return made;
}
