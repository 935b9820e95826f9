'use strict';
(() => {
  const motion = JSON.parse(document.getElementById('motion').textContent);
  const $ = id => document.getElementById(id);
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;

  // What was recorded: for each frame and each body that moves 3 numbers of 16 bits for its place and 4 for its quaternion.
  const places = new DataView(bytes(motion.placements)), times = new Float64Array(bytes(motion.times));
  const energies = new Float32Array(bytes(motion.energies)), KINDS = motion.energyNames.length;
  const frames = times.length, first = times[0], last = times[frames - 1];
  // Times are from the start on, and shown as they are.
  const events = motion.events.map(e => ({ what: e.what, t: e.time - motion.start }));
  const clock = t => (motion.start + t).toFixed(motion.places);

  // Vectors and rotations (row by row).
  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]], scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
  const less = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = a => scaled(a, 1 / (Math.hypot(...a) || 1));
  const turned = (R, a) => [dot(R[0], a), dot(R[1], a), dot(R[2], a)];
  const at = (X, a) => add(turned(X.R, a), X.p);
  const rotation = ([x, y, z, w]) => [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]];

  const FIXED = { R: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], p: [0, 0, 0] };
  function stored(frame, body) {
    const start = 14 * (frame * motion.moving + body);
    const p = [0, 1, 2].map(k => motion.low[k] + motion.quantum[k] * places.getUint16(start + 2 * k, true));
    return { p, o: [0, 1, 2, 3].map(k => places.getInt16(start + 6 + 2 * k, true) / 32767) };
  }

  // The frame at or before a time, and how far on the way to the next one it is.
  function find(t) {
    let low = 0, high = frames - 1;
    while (low < high) { const mid = (low + high + 1) >> 1; if (times[mid] <= t) low = mid; else high = mid - 1; }
    const next = Math.min(low + 1, frames - 1), gap = times[next] - times[low];
    return [low, next, gap > 0 ? Math.min(1, Math.max(0, (t - times[low]) / gap)) : 0];
  }

  // Of a page that a program feeds: the bodies as they are now, the poses that the view has to show, and frames and paths by name.
  const live = { bodies: null, poses: [], frames: {}, trace: {}, lines: [], words: '' };
  const matrix = ([a, b, c, d, e, f, g, h, i, ...p]) => ({ R: [[a, b, c], [d, e, f], [g, h, i]], p });

  // All bodies at a time; body 0 is what does not move.
  function pose(t) {
    if (live.bodies) return live.bodies;
    const [a, b, s] = find(t), all = [FIXED];
    for (let k = 0; k < motion.moving; k++) {
      const A = stored(a, k), B = stored(b, k), sign = A.o.reduce((sum, x, i) => sum + x * B.o[i], 0) < 0 ? -1 : 1;
      const o = A.o.map((x, i) => x * (1 - s) + sign * B.o[i] * s), size = Math.hypot(...o) || 1;
      all.push({ p: add(scaled(A.p, 1 - s), scaled(B.p, s)), R: rotation(o.map(x => x / size)) });
    }
    return all;
  }

  // The eye: it looks at `target`, `up` is up.
  const up = unit(motion.up), side = unit(Math.abs(up[0]) < 0.9 ? cross(up, cross([1, 0, 0], up)) : cross(up, cross([0, 1, 0], up)));
  const ahead = cross(up, side);
  const eye = { azimuth: -0.9, elevation: 0.32, distance: 1, target: [0, 0, 0] };
  let following = null;
  function axes() {
    const c = Math.cos(eye.elevation), s = Math.sin(eye.elevation);
    const back = add(add(scaled(side, c * Math.cos(eye.azimuth)), scaled(ahead, c * Math.sin(eye.azimuth))), scaled(up, s));
    const right = unit(cross(up, back));
    return { right, top: cross(back, right), back };
  }
  // Shapes of links, and boxes of even density with a link's mass and inertia; `edges`: with lines along them.
  const shapes = motion.geometries.map(([points, triangles]) => ({ points: new Float32Array(bytes(points)), triangles: new Uint32Array(bytes(triangles)) }));
  const CORNERS = [0, 1, 2, 3, 4, 5, 6, 7].map(k => [k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1]);
  const CUBE = {
    points: new Float32Array(CORNERS.flat()),
    triangles: new Uint32Array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].flatMap(([a, b, c, d]) => [a, b, c, a, c, d])),
    lines: new Uint32Array([0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7]),
  };
  const HUES = [208, 28, 150, 0, 270, 50, 190, 320];
  // A colour of this hue, red, green and blue from 0 to 1.
  function hue(angle, part, light) {
    const most = part * Math.min(light, 1 - light), k = n => (n + angle / 30) % 12;
    return [0, 8, 4].map(n => light - most * Math.max(-1, Math.min(k(n) - 3, 9 - k(n), 1)));
  }
  const COLLISION = [0.85, 0.35, 0.25];
  const solids = motion.solids.map(x => {
    const own = x.color ? x.color.slice(0, 3) : hue(HUES[x.limb % HUES.length], 0.3, 0.66), seen = x.kind === 'visual';
    return { ...x, mesh: shapes[x.geometry], color: seen ? own : COLLISION, alpha: seen ? (x.color ? x.color[3] : 1) : 0.4 };
  }).concat(motion.boxes.map(b => ({
    ...b, kind: 'inertia', mesh: CUBE, axes: b.axes.map((axis, k) => scaled(axis, b.half[k])), color: hue(HUES[b.limb % HUES.length], 0.45, 0.66), alpha: 0.62,
  })));
  const isThere = kind => solids.some(x => x.kind === kind);
  const isShown = (x, shown) => x.kind === 'inertia' ? shown.boxes || shown.looks && x.alone && isThere('visual') : x.kind === 'visual' ? shown.looks : shown.collision;

  // The place of the ball that is hit.
  const ball = motion.projectile;
  function flight(t) {
    const since = ball.time === null ? 0 : t - ball.time;
    const way = add(ball.place, scaled(since < 0 ? ball.before : ball.after, since));
    return since > 0 ? add(way, scaled(ball.gravity, since * since / 2)) : way;
  }

  // Points and forces of the contacts of each frame.
  const touching = (() => {
    const counts = new Uint16Array(bytes(motion.contactCounts)), numbers = new Float32Array(bytes(motion.contacts)), all = [];
    let at = 0;
    const three = () => { at += 3; return [...numbers.subarray(at - 3, at)]; };
    for (const count of counts) all.push(Array.from({ length: count }, () => ({ point: three(), force: three() })));
    return all;
  })();
  const touches = touching.some(all => all.length);
  const TOUCH = '#c2185b';

  // The corners of the box about a mesh, in its body.
  function corners(x) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity], all = x.mesh.points;
    for (let k = 0; k < all.length; k++) { low[k % 3] = Math.min(low[k % 3], all[k]); high[k % 3] = Math.max(high[k % 3], all[k]); }
    return CORNERS.map(sign => sign.reduce((p, side, k) => add(p, scaled(x.axes[k], side > 0 ? high[k] : low[k])), x.center));
  }
  // What is drawn of each body: corners, ends, and spheres with their radius.
  const outline = (() => {
    const all = Array.from({ length: motion.moving + 1 }, () => []), put = (body, p, r) => all[body].push({ p, r });
    for (const x of solids) if (x.kind === 'visual' || x.alone) corners(x).forEach(p => put(x.body, p, 0));
    for (const s of motion.sticks) { put(s.from, s.start, 0); put(s.to, s.end, 0); }
    for (const b of motion.balls) put(b.body, b.center, b.radius);
    return all;
  })();
  // The nearest place from which nothing leaves the picture in these poses, as the eye looks: |a − x| ≤ k (d − c) for all points (a across, c towards the eye)
  // has its least d at x = k (A − B)/2, with the most A of c + a/k and B of c − a/k.
  function fit(w, h, poses) {
    const { right, top, back } = axes(), room = 0.46 / focus(1, 1), least = Math.min(w, h);
    const most = [right, top].map((axis, i) => ({ axis, k: room * (i ? h : w) / least, A: -Infinity, B: -Infinity }));
    for (const X of poses) outline.forEach((list, body) => list.forEach(({ p, r }) => {
      const place = less(at(X[body], p), motion.center), c = dot(place, back);
      for (const m of most) {
        const a = dot(place, m.axis) / m.k, wide = r * Math.hypot(1, 1 / m.k);
        if (c + a + wide > m.A) m.A = c + a + wide;
        if (c - a + wide > m.B) m.B = c - a + wide;
      }
    }));
    const distance = Math.max(...most.map(m => (m.A + m.B) / 2)), known = Number.isFinite(distance);
    const target = most.reduce((sum, m) => known ? add(sum, scaled(m.axis, m.k * (m.A - m.B) / 2)) : sum, motion.center);
    return { target: [...target], distance: known ? Math.max(distance, 0.05 * motion.radius) : 3.3 * motion.radius };
  }
  function* poses() {
    if (live.bodies) return yield* [...live.poses, live.bodies];
    const stride = Math.max(1, Math.floor(frames / 600));
    for (let k = 0; k < frames; k += stride) yield pose(times[k]);
    yield pose(last);
  }
  // Whether the eye is where one of these put it.
  let fitting = null;
  const sized = seen => fit(view.clientWidth || 1, view.clientHeight || 1, seen);
  // The whole motion, or the robot as it is now.
  function look(fitted, seen) {
    Object.assign(eye, { azimuth: -0.9, elevation: 0.32 });
    Object.assign(eye, sized(seen));
    [following, fitting] = [null, fitted];
  }
  const whole = () => look(whole, poses()), near = () => look(near, [pose(state.t)]);
  // At the start the whole motion, unless the robot would be small in it: then the robot, which is followed.
  function begin() {
    whole();
    // A robot on a fixed base stays where it is.
    const far = motion.root > 0 && eye.distance > 2.5 * sized([pose(first)]).distance;
    $('follow').checked = far;
    if (far) near();
  }
  const focus = (w, h) => 1.5 * Math.min(w, h);
  function camera(w, h) {
    const { right, top, back } = axes(), from = add(eye.target, scaled(back, eye.distance));
    const lens = focus(w, h), near = eye.distance * 0.02;
    return {
      from, right, top, back, near, lens,
      depth: p => -dot(less(p, from), back),
      show(p) { const d = less(p, from), z = Math.max(-dot(d, back), near); return [w / 2 + lens * dot(d, right) / z, h / 2 - lens * dot(d, top) / z, lens / z]; },
    };
  }

  // The ground: a grid about the robot, its meshes 1, 2 or 5 times a power of ten.
  function grid(ctx, cam) {
    const least = motion.radius / 4, power = 10 ** Math.floor(Math.log10(least));
    const mesh = [1, 2, 5, 10].map(m => m * power).find(m => m >= least) || power, n = 10;
    const floor = scaled(up, motion.ground), middle = [side, ahead].map(a => Math.round(dot(eye.target, a) / mesh) * mesh);
    const spot = (i, j) => add(floor, add(scaled(side, middle[0] + i * mesh), scaled(ahead, middle[1] + j * mesh)));
    const stroke = (a, b, fade, strong) => {
      let za = cam.depth(a), zb = cam.depth(b);
      if (za < cam.near && zb < cam.near) return;
      if (za < cam.near) a = add(a, scaled(less(b, a), (cam.near - za) / (zb - za)));
      if (zb < cam.near) b = add(b, scaled(less(a, b), (cam.near - zb) / (za - zb)));
      const [x1, y1] = cam.show(a), [x2, y2] = cam.show(b);
      ctx.strokeStyle = `rgba(110, 125, 140, ${fade * (strong ? 0.75 : 0.4)})`;
      ctx.beginPath(); ctx.moveTo(x1, y1); ctx.lineTo(x2, y2); ctx.stroke();
    };
    ctx.lineWidth = 1;
    for (let i = -n; i <= n; i++) for (let j = -n; j < n; j++) {
      const fade = Math.max(0, 1 - Math.hypot(i, j + 0.5) / n);
      if (fade <= 0) continue;
      stroke(spot(i, j), spot(i, j + 1), fade, Math.abs(middle[0] + i * mesh) < mesh / 2);
      stroke(spot(j, i), spot(j + 1, i), fade, Math.abs(middle[1] + i * mesh) < mesh / 2);
    }
    return mesh;
  }

  const LIGHT = unit(add(up, add(scaled(side, 0.5), scaled(ahead, -0.35))));
  // A solid in the world: its origin, and its axes.
  const placed = (x, X) => ({ x, o: at(X[x.body], x.center), A: x.axes.map(axis => turned(X[x.body].R, axis)) });

  // Solids by WebGL, in a picture of their own with what is between them left open; null without WebGL.
  function painter() {
    const canvas = document.createElement('canvas'), gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
    if (!gl) return null;
    const VERTEX = `#version 300 es
      in vec3 p; uniform mat3 A; uniform vec3 o, right, top, back; uniform vec4 lens; out vec3 place;
      void main() {
        place = A * p + o;
        float z = -dot(place, back), n = lens.z, f = lens.w;
        gl_Position = vec4(lens.x * dot(place, right), lens.y * dot(place, top), ((f + n) * z - 2.0 * n * f) / (f - n), z);
      }`;
    const FRAGMENT = `#version 300 es
      precision highp float; in vec3 place; uniform vec3 light; uniform vec4 color; uniform float flatness; out vec4 seen;
      void main() {
        vec3 n = cross(dFdx(place), dFdy(place));
        n = normalize(dot(n, place) > 0.0 ? -n : n);
        float shade = mix(0.72 + 0.32 * dot(n, light), 1.0, flatness);
        seen = vec4(min(color.rgb * shade, 1.0) * color.a, color.a);
      }`;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind); gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, 'p');
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
    const place = Object.fromEntries(['A', 'o', 'right', 'top', 'back', 'lens', 'light', 'color', 'flatness'].map(name => [name, gl.getUniformLocation(program, name)]));
    const buffer = (kind, data) => { const b = gl.createBuffer(); gl.bindBuffer(kind, b); gl.bufferData(kind, data, gl.STATIC_DRAW); return b; };
    const kept = new Map();
    const buffers = mesh => {
      if (!kept.has(mesh)) kept.set(mesh, [buffer(gl.ARRAY_BUFFER, mesh.points), buffer(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles), mesh.lines && buffer(gl.ELEMENT_ARRAY_BUFFER, mesh.lines)]);
      return kept.get(mesh);
    };
    return (ctx, w, h, cam, all) => {
      const scale = window.devicePixelRatio || 1, size = [Math.round(w * scale), Math.round(h * scale)];
      if (gl.isContextLost()) return false;
      if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
      gl.viewport(0, 0, ...size);
      gl.clearColor(0, 0, 0, 0); gl.depthMask(true); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST); gl.enable(gl.BLEND); gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA); gl.depthFunc(gl.LEQUAL);
      gl.useProgram(program);
      for (const name of ['right', 'top', 'back']) gl.uniform3fv(place[name], cam[name]);
      gl.uniform3fv(place.light, LIGHT);
      gl.uniform4f(place.lens, 2 * cam.lens / w, 2 * cam.lens / h, cam.near, eye.distance + 1e3 * motion.radius);
      const open = s => s.x.alpha < 1, back = s => cam.depth(s.o);
      // The far ones first of those that are seen through.
      for (const s of [...all.filter(s => !open(s)), ...all.filter(open).sort((a, b) => back(b) - back(a))]) {
        const [points, triangles, lines] = buffers(s.x.mesh);
        gl.bindBuffer(gl.ARRAY_BUFFER, points); gl.enableVertexAttribArray(0); gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
        gl.uniformMatrix3fv(place.A, false, s.A.flat()); gl.uniform3fv(place.o, less(s.o, cam.from));
        gl.uniform4f(place.color, ...s.x.color, s.x.alpha); gl.uniform1f(place.flatness, 0);
        gl.depthMask(!open(s));
        if (open(s)) gl.enable(gl.CULL_FACE); else gl.disable(gl.CULL_FACE);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, triangles); gl.drawElements(gl.TRIANGLES, s.x.mesh.triangles.length, gl.UNSIGNED_INT, 0);
        if (lines) {
          gl.uniform4f(place.color, ...scaled(s.x.color, 0.5), 0.55); gl.uniform1f(place.flatness, 1);
          gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lines); gl.drawElements(gl.LINES, s.x.mesh.lines.length, gl.UNSIGNED_INT, 0);
        }
      }
      ctx.drawImage(canvas, 0, 0, w, h);
      return true;
    };
  }

  // The same without WebGL: the far triangles first.
  function plainly(ctx, w, h, cam, all) {
    const faces = [];
    for (const { x, o, A } of all) {
      const { points, triangles } = x.mesh, seen = [];
      for (let k = 0; k < points.length; k += 3) seen.push(add(o, add(scaled(A[0], points[k]), add(scaled(A[1], points[k + 1]), scaled(A[2], points[k + 2])))));
      for (let k = 0; k < triangles.length; k += 3) {
        const [a, b, c] = [0, 1, 2].map(i => seen[triangles[k + i]]), depth = [a, b, c].map(cam.depth), n = unit(cross(less(b, a), less(c, a)));
        if (depth.some(d => d < cam.near) || dot(n, less(a, cam.from)) >= 0) continue;
        faces.push({ depth: depth[0] + depth[1] + depth[2], points: [a, b, c].map(cam.show), shade: 0.72 + 0.32 * dot(n, LIGHT), x });
      }
    }
    for (const f of faces.sort((a, b) => b.depth - a.depth)) {
      ctx.fillStyle = `rgba(${f.x.color.map(part => Math.round(255 * Math.min(1, part * f.shade)))}, ${f.x.alpha})`;
      ctx.beginPath(); f.points.forEach(([x, y], k) => { if (k) ctx.lineTo(x, y); else ctx.moveTo(x, y); }); ctx.closePath(); ctx.fill();
    }
    return true;
  }
  const paint = painter();

  // Names of joints: each beside its joint where it covers neither a panel, nor a joint, nor another name; the nearest to the eye first, and none where there is no
  // such place. A name stays on its side as long as it can.
  const SIDES = [[9, -6], [9, 16], [-9, -6], [-9, 16], [0, -12], [0, 22], [14, 5], [-14, 5]], sides = new Map();
  function names(ctx, w, h, marks, panels) {
    ctx.font = '11px "DejaVu Sans", Verdana, Arial, sans-serif';
    const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    const taken = [...panels, ...marks.map(({ spot: [x, y] }) => [x - 5, y - 5, x + 5, y + 5])], written = [];
    for (const { joint, spot: [x, y] } of marks.slice().sort((a, b) => a.depth - b.depth)) {
      const wide = ctx.measureText(joint.label).width, old = sides.get(joint);
      const box = ([dx, dy]) => { const left = dx > 0 ? x + dx : dx < 0 ? x + dx - wide : x - wide / 2; return [left - 2, y + dy - 10, left + wide + 2, y + dy + 3]; };
      const free = b => b[0] >= 0 && b[1] >= 0 && b[2] <= w && b[3] <= h && !taken.some(other => meet(b, other));
      const there = [...(old ? [old] : []), ...SIDES].find(s => free(box(s)));
      if (!there) { sides.delete(joint); continue; }
      sides.set(joint, there);
      const b = box(there);
      taken.push(b); written.push({ name: joint.name, box: b });
      label(ctx, joint.label, b[0] + 2, b[3] - 3);
    }
    return written;
  }

  // Paths, and the axes of frames: x red, y green, z blue.
  const PATH = '#7b3fa0', LINE = 'rgba(27, 108, 168, .45)', AXES = ['#c62828', '#2e7d32', '#1565c0'];
  function traces(ctx, cam) {
    const line = points => {
      ctx.beginPath();
      let down = false;
      for (const p of points) {
        const there = cam.depth(p) > cam.near, [x, y] = cam.show(p);
        if (there && down) ctx.lineTo(x, y); else if (there) ctx.moveTo(x, y);
        down = there;
      }
      ctx.stroke();
    };
    ctx.strokeStyle = LINE; ctx.lineWidth = 1;
    live.lines.forEach(line);
    ctx.strokeStyle = PATH; ctx.lineWidth = 1.6;
    Object.values(live.trace).forEach(line);
    ctx.lineWidth = 2.4;
    for (const [name, { R, p }] of Object.entries(live.frames)) {
      AXES.forEach((color, k) => { ctx.strokeStyle = color; line([p, add(p, scaled(R.map(row => row[k]), 0.12 * motion.size))]); });
      const [x, y] = cam.show(p);
      if (cam.depth(p) > cam.near) label(ctx, name, x + 6, y + 14);
    }
  }

  // Draws the motion at a time; gives the places of links and joints on the screen, for names under the pointer.
  function draw(ctx, w, h, t, shown, panels) {
    const X = pose(t);
    if (shown.follow && motion.moving) {
      // The base, if it moves; else the middle of all.
      const middle = motion.root ? X[motion.root].p : scaled(X.slice(1).reduce((sum, x) => add(sum, x.p), [0, 0, 0]), 1 / motion.moving);
      if (following) eye.target = add(eye.target, less(middle, following));
      following = middle;
    } else following = null;
    const cam = camera(w, h), spots = [];
    ctx.fillStyle = '#f4f6f8'; ctx.fillRect(0, 0, w, h);
    ctx.lineCap = ctx.lineJoin = 'round';
    const mesh = grid(ctx, cam);
    const stick = s => [at(X[s.from], s.start), at(X[s.to], s.end)];
    // what the sun leaves dark
    ctx.strokeStyle = 'rgba(60, 70, 80, .16)';
    for (const s of motion.sticks) {
      const [a, b] = stick(s).map(p => add(p, scaled(up, motion.ground - dot(p, up))));
      if (cam.depth(a) < cam.near || cam.depth(b) < cam.near) continue;
      const [x1, y1, z1] = cam.show(a), [x2, y2] = cam.show(b);
      ctx.lineWidth = Math.max(1.5, 0.02 * motion.size * z1);
      ctx.beginPath(); ctx.moveTo(x1, y1); ctx.lineTo(x2, y2); ctx.stroke();
    }
    const all = solids.filter(x => isShown(x, shown)).map(x => placed(x, X));
    if (!paint || !paint(ctx, w, h, cam, all)) plainly(ctx, w, h, cam, all);
    for (const b of motion.balls) {
      const p = at(X[b.body], b.center); if (cam.depth(p) < cam.near) continue;
      const [x, y, z] = cam.show(p);
      ctx.strokeStyle = 'rgba(160, 40, 40, .8)'; ctx.lineWidth = 1;
      ctx.beginPath(); ctx.arc(x, y, Math.max(1, b.radius * z), 0, 2 * Math.PI); ctx.stroke();
    }
    if (shown.contacts) {
      // Of the nearest frame: contacts begin and end within a step.
      const [a, b, s] = find(t);
      ctx.strokeStyle = ctx.fillStyle = TOUCH; ctx.lineWidth = 2.2;
      for (const { point, force } of touching[s < 0.5 ? a : b] || []) {
        const tip = add(point, scaled(force, Math.min(motion.newton, 1.5 * motion.size / (Math.hypot(...force) || 1))));
        if (cam.depth(point) < cam.near || cam.depth(tip) < cam.near) continue;
        const [x, y] = cam.show(point), [x2, y2] = cam.show(tip), long = Math.hypot(x2 - x, y2 - y), head = Math.min(8, 0.5 * long);
        ctx.beginPath(); ctx.arc(x, y, 2.6, 0, 2 * Math.PI); ctx.fill();
        if (long < 1) continue;
        const [dx, dy] = [(x2 - x) / long, (y2 - y) / long], back = side => [x2 - head * dx - side * head * 0.5 * dy, y2 - head * dy + side * head * 0.5 * dx];
        ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x2 - 0.8 * head * dx, y2 - 0.8 * head * dy); ctx.stroke();
        ctx.beginPath(); ctx.moveTo(x2, y2); ctx.lineTo(...back(1)); ctx.lineTo(...back(-1)); ctx.fill();
      }
    }
    if (ball) {
      // Its way since it was hit, and where it is.
      const now = flight(t), from = ball.time !== null && t > ball.time;
      ctx.strokeStyle = 'rgba(200, 120, 20, .8)'; ctx.lineWidth = 1.2; ctx.setLineDash([4, 4]); ctx.beginPath();
      for (let k = 0; from && k <= 40; k++) {
        const p = flight(ball.time + (t - ball.time) * k / 40);
        if (cam.depth(p) < cam.near) break;
        const [x, y] = cam.show(p);
        if (k) ctx.lineTo(x, y); else ctx.moveTo(x, y);
      }
      ctx.stroke(); ctx.setLineDash([]);
      if (cam.depth(now) > cam.near) {
        const [x, y, z] = cam.show(now);
        ctx.fillStyle = '#f2a93b'; ctx.strokeStyle = '#8a5410'; ctx.lineWidth = 1.2;
        ctx.beginPath(); ctx.arc(x, y, Math.max(3, ball.radius * z), 0, 2 * Math.PI); ctx.fill(); ctx.stroke();
      }
    }
    const marks = motion.joints.map(joint => ({ joint, p: at(X[joint.body], joint.place) })).map(m => ({ ...m, depth: cam.depth(m.p), spot: cam.show(m.p) })).filter(m => m.depth > cam.near);
    if (shown.sticks) {
      ctx.strokeStyle = '#26323e';
      for (const s of motion.sticks) {
        const [a, b] = stick(s); if (cam.depth(a) < cam.near || cam.depth(b) < cam.near) continue;
        const [x1, y1, z1] = cam.show(a), [x2, y2] = cam.show(b);
        ctx.lineWidth = Math.min(5, Math.max(1.4, 0.012 * motion.size * z1));
        ctx.beginPath(); ctx.moveTo(x1, y1); ctx.lineTo(x2, y2); ctx.stroke();
      }
      ctx.strokeStyle = '#fff'; ctx.fillStyle = '#d9622b';
      for (const { spot: [x, y, z] } of marks) {
        ctx.lineWidth = 1; ctx.beginPath(); ctx.arc(x, y, Math.min(6, Math.max(2, 0.014 * motion.size * z)), 0, 2 * Math.PI); ctx.fill(); ctx.stroke();
      }
    }
    traces(ctx, cam);
    const written = shown.names ? names(ctx, w, h, marks, panels) : [];
    for (const b of motion.boxes) spots.push({ at: cam.show(at(X[b.body], b.center)), name: `${b.name}, ${number(b.mass)} kg` });
    for (const m of marks) spots.push({ at: m.spot, name: m.joint.name });
    return { spots, mesh, written };
  }

  const number = x => Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 || x === 0 ? x.toPrecision(4) : x.toExponential(2);
  const ENERGY = ['#1b6ca8', '#d9822b', '#3f8f5b'];
  function series(kind, k) { return kind < 2 ? energies[KINDS * k + kind] : energies[KINDS * k] + energies[KINDS * k + 1]; }

  // The strip under the picture: T, U and T + U, events, and the present time. Its numbers are
  // beside the curves.
  const MARGIN = 76;
  function strip(ctx, w, h, t) {
    let low = Infinity, high = -Infinity;
    for (let k = 0; k < frames; k++) for (let kind = 0; kind < 3; kind++) { const x = series(kind, k); if (x < low) low = x; if (x > high) high = x; }
    const ends = [low, high];
    const span = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? high - low : 1;
    const X = s => MARGIN + (s - first) / (last - first || 1) * (w - MARGIN - 2) + 1, Y = e => h - 4 - (e - low) / span * (h - 8);
    ctx.clearRect(0, 0, w, h);
    if (low <= 0 && high >= 0) { ctx.strokeStyle = '#aab'; ctx.lineWidth = 1; ctx.beginPath(); ctx.moveTo(MARGIN, Y(0)); ctx.lineTo(w, Y(0)); ctx.stroke(); }
    // Of events that are nearer than three points to one another the first is drawn; many are pale.
    ctx.strokeStyle = `rgba(160, 40, 40, ${events.length > 20 ? 0.25 : 0.6})`; ctx.lineWidth = 1;
    let drawn = -Infinity;
    for (const e of events) { const x = X(e.t); if (x - drawn < 3) continue; drawn = x; ctx.beginPath(); ctx.moveTo(x, 0); ctx.lineTo(x, h); ctx.stroke(); }
    for (const kind of [0, 1, 2]) {
      ctx.strokeStyle = ENERGY[kind]; ctx.lineWidth = 1.4; ctx.beginPath();
      for (let k = 0; k < frames; k++) { const y = Y(series(kind, k)); if (k) ctx.lineTo(X(times[k]), y); else ctx.moveTo(X(times[k]), y); }
      ctx.stroke();
    }
    ctx.strokeStyle = '#222'; ctx.lineWidth = 1.5; ctx.beginPath(); ctx.moveTo(X(t), 0); ctx.lineTo(X(t), h); ctx.stroke();
    label(ctx, `${number(ends[1])} J`, 4, 11);
    label(ctx, `${number(ends[0])} J`, 4, h - 3);
    if (low < 0 && high > 0 && Y(0) > 24 && Y(0) < h - 16) label(ctx, '0', 4, Y(0) + 4);
  }
  // A number in the strip, readable over curves.
  function label(ctx, text, x, y) {
    ctx.font = '11px "DejaVu Sans", Verdana, Arial, sans-serif';
    ctx.lineWidth = 3; ctx.strokeStyle = 'rgba(255, 255, 255, .85)'; ctx.strokeText(text, x, y);
    ctx.fillStyle = '#445'; ctx.fillText(text, x, y);
  }

  // Columns of a number beside the picture.
  const wide = Math.max(10, clock(first).length, clock(last).length);
  function readout(t) {
    const [a, b, s] = find(t), value = kind => energies[KINDS * a + kind] * (1 - s) + energies[KINDS * b + kind] * s;
    const line = (name, text, unit) => `${name.padEnd(12)} ${text.padStart(wide)} ${unit}`;
    const lines = [line('time', clock(t), 's')];
    motion.energyNames.forEach((name, kind) => lines.push(line(name, number(value(kind)), 'J')));
    if (KINDS) lines.splice(3, 0, line('T + U', number(value(0) + value(1)), 'J'));
    const before = events.filter(e => e.t <= t).pop();
    if (before) lines.push('', `${clock(before.t)} s: ${before.what}`);
    return lines.join('\n');
  }

  // From here on: buttons, mouse, clock.
  const view = $('view'), stripCanvas = $('strip'), scrub = $('scrub'), play = $('play'), tip = $('tip');
  const state = { t: first, playing: true, before: null, spots: [], written: [], recorder: null, ending: false };
  const TOGGLES = ['looks', 'collision', 'boxes', 'sticks', 'names', 'contacts', 'follow'];
  const shown = () => Object.fromEntries(TOGGLES.map(name => [name, $(name).checked]));
  // What is not there has no toggle; boxes are for robots without a look of their own.
  $('boxes').checked = !isThere('visual');
  // Sticks and names would be inside meshes, and in front of them.
  for (const name of ['sticks', 'names']) $(name).checked = !motion.hasMeshes;
  for (const [name, kind] of [['looks', 'visual'], ['collision', 'collision'], ['boxes', 'inertia']]) $(name).parentElement.hidden = !isThere(kind);
  $('contacts').parentElement.hidden = !touches;
  const panels = () => ['head', 'numbers', 'legend'].map($).filter(panel => !panel.hidden).map(panel => panel.getBoundingClientRect()).map(b => [b.left, b.top, b.right, b.bottom]);
  // The legend of what is shown: materials by their names, and all else by its kind.
  function legend() {
    const now = shown(), rows = new Map(), css = color => `rgb(${color.map(part => Math.round(255 * part))})`;
    const put = (text, color, round) => { if (!rows.has(text)) rows.set(text, { color, round }); };
    for (const x of solids.filter(x => x.kind === 'visual' && isShown(x, now))) put(x.material || 'link', css(x.color));
    if (solids.some(x => x.kind === 'inertia' && isShown(x, now))) put('inertia box', css(hue(HUES[0], 0.45, 0.66)));
    if (now.collision && isThere('collision')) put('collision shape', css(COLLISION));
    if (motion.balls.length) put('contact sphere', '#a02828', true);
    if (now.contacts && touches) put('contact force', TOUCH, true);
    if (now.sticks && motion.joints.length) put('joint', '#d9622b', true);
    if (ball) put('ball', '#f2a93b', true);
    for (const name of Object.keys(live.trace)) put(`path of ${name}`, PATH, true);
    const all = [...rows], most = 12, box = $('legend');
    box.replaceChildren(...all.slice(0, most).map(([text, { color, round }]) => {
      const row = document.createElement('div'), swatch = document.createElement('i');
      swatch.style.background = color; swatch.style.borderRadius = round ? '50%' : '2px';
      row.append(swatch, text.length > 32 ? `${text.slice(0, 15)}…${text.slice(-15)}` : text);
      return row;
    }));
    if (all.length > most) box.append(`and ${all.length - most} more`);
    box.hidden = !all.length;
  }
  TOGGLES.forEach(name => $(name).addEventListener('change', legend));
  legend();
  for (const x of motion.speeds) $('speed').add(new Option(`${x}×`, x, x === motion.speed, x === motion.speed));
  scrub.min = first; scrub.max = last;
  $('numbers').style.width = `${wide + 16}ch`;
  function fitted(canvas) {
    const scale = window.devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
    if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) { canvas.width = Math.round(w * scale); canvas.height = Math.round(h * scale); }
    const ctx = canvas.getContext('2d');
    ctx.setTransform(scale, 0, 0, scale, 0, 0);
    return [ctx, w, h];
  }
  // The picture; of one that is saved, panels cover nothing, and its title is in it.
  function picture(saved) {
    const [ctx, w, h] = fitted(view), text = motion.isLive ? document.title : `${document.title}   ${clock(state.t)} s`;
    ctx.font = '13px "DejaVu Sans", Verdana, Arial, sans-serif';
    const caption = [8, 8, 28 + ctx.measureText(text).width, 34];
    const drawn = draw(ctx, w, h, state.t, shown(), saved ? [caption] : panels());
    if (saved) { ctx.font = '13px "DejaVu Sans", Verdana, Arial, sans-serif'; ctx.fillStyle = '#222'; ctx.fillText(text, 16, 25); }
    return drawn;
  }
  function show() {
    const { spots, mesh, written } = picture(state.recorder !== null);
    [state.spots, state.written] = [spots, written];
    strip(...fitted(stripCanvas), state.t);
    $('numbers').textContent = readout(state.t);
    $('note').textContent = `${motion.note}; squares of the ground ${Number(mesh.toPrecision(3))} m${live.words}`;
    scrub.value = state.t;
    play.textContent = state.playing ? 'Pause' : 'Play';
  }
  function tick(now) {
    if (state.playing && state.before !== null) {
      state.t += (now - state.before) / 1000 * Number($('speed').value);
      if (state.t >= last) { if ($('loop').checked && last > first && !state.recorder) state.t = first + (state.t - first) % (last - first); else { state.t = last; state.playing = false; } following = null; }
    }
    state.before = now;
    show();
    if (state.recorder && state.t >= last && !state.ending) {
      // The last picture stays for a while.
      state.ending = true;
      setTimeout(() => { if (state.recorder) state.recorder.stop(); }, 500);
    }
    requestAnimationFrame(tick);
  }
  const go = t => { state.t = Math.min(last, Math.max(first, t)); following = null; };
  const toggle = () => { if (!state.playing && state.t >= last) go(first); state.playing = !state.playing; };
  play.onclick = toggle;
  $('home').onclick = whole;
  $('near').onclick = near;

  // Files: the picture, and the motion from its start to its end at the speed that is chosen.
  function save(blob, ending) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = `${document.title.replace(/[^\p{L}\p{N}._-]+/gu, '_') || 'motion'}.${ending}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  }
  $('png').onclick = () => { picture(true); view.toBlob(blob => save(blob, 'png')); };
  const VIDEO = ['video/webm;codecs=vp9', 'video/webm', 'video/mp4'].find(type => window.MediaRecorder && view.captureStream && MediaRecorder.isTypeSupported(type));
  if (!VIDEO) { $('video').disabled = true; $('video').title = 'This browser records no video'; }
  $('video').onclick = () => {
    if (state.recorder) return state.recorder.stop();
    const recorder = new MediaRecorder(view.captureStream(30), { mimeType: VIDEO, videoBitsPerSecond: 8e6 }), parts = [];
    recorder.ondataavailable = e => parts.push(e.data);
    recorder.onstop = () => {
      [state.recorder, state.ending] = [null, false];
      $('video').textContent = 'Save video';
      if (parts.every(part => !part.size)) $('video').title = 'This browser recorded no picture: a slower speed gives it more time';
      else save(new Blob(parts, { type: VIDEO.split(';')[0] }), VIDEO.includes('mp4') ? 'mp4' : 'webm');
    };
    go(first);
    [state.recorder, state.playing] = [recorder, false];
    recorder.onstart = () => { state.playing = true; };
    $('video').textContent = 'End video';
    recorder.start(1000);
  };
  scrub.oninput = () => { state.playing = false; go(Number(scrub.value)); };
  const strike = e => { const box = stripCanvas.getBoundingClientRect(); state.playing = false; go(first + (e.clientX - box.left - MARGIN) / (box.width - MARGIN) * (last - first)); };
  stripCanvas.onpointerdown = e => { stripCanvas.setPointerCapture(e.pointerId); strike(e); };
  stripCanvas.onpointermove = e => { if (e.buttons) strike(e); };
  document.addEventListener('keydown', e => {
    if (e.target === scrub || e.target === $('speed')) return;
    const frame = find(state.t)[0];
    if (e.key === ' ') { if (!['BUTTON', 'INPUT'].includes(e.target.tagName)) { toggle(); e.preventDefault(); } }
    else if (e.key === 'ArrowRight') { state.playing = false; go(times[Math.min(frame + 1, frames - 1)]); }
    else if (e.key === 'ArrowLeft') { state.playing = false; go(state.t > times[frame] ? times[frame] : times[Math.max(frame - 1, 0)]); }
    else if (e.key === 'Home') whole();
  });
  const pointers = new Map();
  const nearer = factor => { fitting = null; eye.distance = Math.min(1e3 * motion.radius, Math.max(1e-2 * motion.radius, eye.distance * factor)); };
  const spread = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  view.onpointerdown = e => { view.setPointerCapture(e.pointerId); pointers.set(e.pointerId, { x: e.clientX, y: e.clientY }); };
  view.onpointerup = view.onpointercancel = e => pointers.delete(e.pointerId);
  view.onpointerleave = () => { tip.hidden = true; };
  view.onpointermove = e => {
    const old = pointers.get(e.pointerId);
    if (!old) return name(e);
    fitting = null;
    const dx = e.clientX - old.x, dy = e.clientY - old.y, apart = pointers.size === 2 ? spread() : 0;
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (pointers.size === 2) nearer(apart / (spread() || 1));
    else if (e.shiftKey || e.buttons & 6) {
      const cam = camera(view.clientWidth, view.clientHeight), scale = eye.distance / focus(view.clientWidth, view.clientHeight);
      eye.target = add(eye.target, add(scaled(cam.right, -dx * scale), scaled(cam.top, dy * scale)));
    } else {
      eye.azimuth -= dx * 0.008;
      eye.elevation = Math.min(1.55, Math.max(-1.55, eye.elevation + dy * 0.008));
    }
  };
  // In a frame of another page the wheel and upright strokes move that page; the wheel is the picture's after a click on it.
  const framed = window !== window.top;
  if (framed) view.style.touchAction = 'pan-y';
  view.addEventListener('wheel', e => {
    if (framed && !(document.hasFocus() && document.activeElement === view)) return;
    e.preventDefault();
    nearer(Math.exp(e.deltaY * (e.deltaMode ? 0.05 : 0.0015)));
  }, { passive: false });
  view.oncontextmenu = e => e.preventDefault();
  function name(e) {
    const away = s => Math.hypot(s.at[0] - e.clientX, s.at[1] - e.clientY), near = state.spots.filter(s => away(s) < 14).sort((a, b) => away(a) - away(b))[0];
    tip.hidden = !near;
    if (near) { tip.textContent = near.name; tip.style.left = `${e.clientX + 14}px`; tip.style.top = `${e.clientY + 10}px`; }
  }
  window.addEventListener('resize', () => { if (fitting) fitting(); });
  // What a program sends. Without a token in the address the page shows the robot as it was when it was made.
  const token = new URLSearchParams(location.search).get('token');
  if (motion.isLive) document.body.classList.add('live');
  if (motion.isLive && token) {
    const source = new EventSource(`events?token=${encodeURIComponent(token)}`), end = () => { source.close(); live.words = '; no connection'; };
    source.onopen = () => { live.words = '; live'; };
    source.addEventListener('end', end);
    source.onerror = end;
    source.onmessage = e => {
      const now = JSON.parse(e.data), before = Object.keys(live.trace).join('\n'), three = all => Array.from({ length: all.length / 3 }, (_, k) => all.slice(3 * k, 3 * k + 3));
      live.bodies = [FIXED, ...now.placements.map(matrix)];
      // The view grows with the motion, until a user moves it.
      if (fitting && !following) {
        const view = JSON.stringify(eye);
        whole();
        if ((JSON.stringify(eye) !== view || !live.poses.length) && live.poses.push(live.bodies) > 200) live.poses = live.poses.filter((_, k) => k % 2);
      }
      live.frames = Object.fromEntries(Object.entries(now.frames).map(([name, row]) => [name, matrix(row)]));
      live.lines = now.lines.map(three);
      live.trace = Object.fromEntries(Object.entries(now.trace).map(([name, all]) => [name, three(all)]));
      if (Object.keys(live.trace).join('\n') !== before) legend();
    };
  }
  begin();
  requestAnimationFrame(tick);
})();
