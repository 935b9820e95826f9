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

  // All bodies at a time; body 0 is what does not move.
  function pose(t) {
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
  // What is drawn of each body: corners, ends, and spheres with their radius.
  function points() {
    const all = Array.from({ length: motion.moving + 1 }, () => []), put = (body, p, r) => all[body].push({ p, r });
    for (const b of motion.boxes) for (let k = 0; k < 8; k++) {
      const reach = [4, 2, 1].map((bit, i) => scaled(b.axes[i], (k & bit ? 1 : -1) * b.half[i]));
      put(b.body, reach.reduce(add, b.center), 0);
    }
    for (const s of motion.sticks) { put(s.from, s.start, 0); put(s.to, s.end, 0); }
    for (const b of motion.balls) put(b.body, b.center, b.radius);
    return all;
  }
  // The nearest place from which nothing leaves the picture during the motion, as the eye looks: |a − x| ≤ k (d − c) for all points (a across, c towards the eye)
  // has its least d at x = k (A − B)/2, with the most A of c + a/k and B of c − a/k.
  function fit(w, h) {
    const { right, top, back } = axes(), room = 0.46 / focus(1, 1), least = Math.min(w, h);
    const most = [right, top].map((axis, i) => ({ axis, k: room * (i ? h : w) / least, A: -Infinity, B: -Infinity }));
    const drawn = points(), stride = Math.max(1, Math.floor(frames / 600));
    const reach = X => drawn.forEach((list, body) => list.forEach(({ p, r }) => {
      const place = less(at(X[body], p), motion.center), c = dot(place, back);
      for (const m of most) {
        const a = dot(place, m.axis) / m.k, wide = r * Math.hypot(1, 1 / m.k);
        if (c + a + wide > m.A) m.A = c + a + wide;
        if (c - a + wide > m.B) m.B = c - a + wide;
      }
    }));
    for (let k = 0; k < frames; k += stride) reach(pose(times[k]));
    reach(pose(last));
    const distance = Math.max(...most.map(m => (m.A + m.B) / 2)), known = Number.isFinite(distance);
    const target = most.reduce((sum, m) => known ? add(sum, scaled(m.axis, m.k * (m.A - m.B) / 2)) : sum, motion.center);
    return { target: [...target], distance: known ? Math.max(distance, 0.05 * motion.radius) : 3.3 * motion.radius };
  }
  // Whether the eye is where `whole` put it.
  let fitting = true;
  function whole() {
    Object.assign(eye, { azimuth: -0.9, elevation: 0.32 });
    Object.assign(eye, fit(view.clientWidth || 1, open(view.clientHeight || 1)));
    [following, fitting] = [null, true];
  }
  // The height of the picture above the panel at its foot.
  const open = h => Math.max(0.4 * h, Math.min(h, $('foot').offsetTop || h));
  const focus = (w, h) => 1.5 * Math.min(w, h);
  function camera(w, h) {
    const { right, top, back } = axes(), from = add(eye.target, scaled(back, eye.distance));
    const free = open(h), lens = focus(w, free);
    const near = eye.distance * 0.02;
    return {
      from, right, top, near,
      depth: p => -dot(less(p, from), back),
      show(p) { const d = less(p, from), z = Math.max(-dot(d, back), near); return [w / 2 + lens * dot(d, right) / z, 0.5 * free - lens * dot(d, top) / z, lens / z]; },
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

  const FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
  const LIGHT = unit(add(up, add(scaled(side, 0.5), scaled(ahead, -0.35))));
  const HUES = [208, 28, 150, 0, 270, 50, 190, 320];
  function faces(box, X, cam) {
    const o = at(X, box.center), R = box.axes.map(a => turned(X.R, a));
    const corner = k => add(o, add(scaled(R[0], (k & 4 ? 1 : -1) * box.half[0]), add(scaled(R[1], (k & 2 ? 1 : -1) * box.half[1]), scaled(R[2], (k & 1 ? 1 : -1) * box.half[2]))));
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(corner);
    const out = [];
    for (const [f, ids] of FACES.entries()) {
      const normal = scaled(R[f >> 1], f & 1 ? 1 : -1), points = ids.map(k => corners[k]);
      if (dot(normal, less(points[0], cam.from)) >= 0 || points.some(p => cam.depth(p) < cam.near)) continue;
      out.push({ depth: points.reduce((s, p) => s + cam.depth(p), 0) / 4, points, shade: 0.5 + 0.5 * dot(normal, LIGHT), hue: HUES[box.limb % HUES.length] });
    }
    return out;
  }

  // Draws the motion at a time; gives the places of the boxes' centers on the screen, for names under the pointer.
  function draw(ctx, w, h, t, shown) {
    const X = pose(t);
    if (shown.follow && motion.moving) {
      if (following) eye.target = add(eye.target, less(X[motion.root].p, following));
      following = X[motion.root].p;
    } else following = null;
    const cam = camera(w, h), spots = [];
    ctx.clearRect(0, 0, w, h);
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
    if (shown.boxes) {
      const all = motion.boxes.flatMap(box => faces(box, X[box.body], cam)).sort((a, b) => b.depth - a.depth);
      for (const f of all) {
        ctx.beginPath();
        f.points.forEach((p, k) => { const [x, y] = cam.show(p); if (k) ctx.lineTo(x, y); else ctx.moveTo(x, y); });
        ctx.closePath();
        ctx.fillStyle = `hsla(${f.hue}, 45%, ${45 + 30 * f.shade}%, .62)`; ctx.fill();
        ctx.strokeStyle = `hsla(${f.hue}, 45%, 30%, .55)`; ctx.lineWidth = 0.8; ctx.stroke();
      }
    }
    for (const b of motion.balls) {
      const p = at(X[b.body], b.center); if (cam.depth(p) < cam.near) continue;
      const [x, y, z] = cam.show(p);
      ctx.strokeStyle = 'rgba(160, 40, 40, .8)'; ctx.lineWidth = 1;
      ctx.beginPath(); ctx.arc(x, y, Math.max(1, b.radius * z), 0, 2 * Math.PI); ctx.stroke();
    }
    if (shown.sticks) {
      ctx.strokeStyle = '#26323e';
      for (const s of motion.sticks) {
        const [a, b] = stick(s); if (cam.depth(a) < cam.near || cam.depth(b) < cam.near) continue;
        const [x1, y1, z1] = cam.show(a), [x2, y2] = cam.show(b);
        ctx.lineWidth = Math.min(5, Math.max(1.4, 0.012 * motion.size * z1));
        ctx.beginPath(); ctx.moveTo(x1, y1); ctx.lineTo(x2, y2); ctx.stroke();
      }
      ctx.strokeStyle = '#fff'; ctx.fillStyle = '#d9622b';
      for (const j of motion.joints) {
        const p = at(X[j.body], j.place); if (cam.depth(p) < cam.near) continue;
        const [x, y, z] = cam.show(p);
        ctx.lineWidth = 1; ctx.beginPath(); ctx.arc(x, y, Math.min(6, Math.max(2, 0.014 * motion.size * z)), 0, 2 * Math.PI); ctx.fill(); ctx.stroke();
      }
    }
    for (const b of motion.boxes) spots.push({ at: cam.show(at(X[b.body], b.center)), name: `${b.name}, ${number(b.mass)} kg` });
    for (const j of motion.joints) spots.push({ at: cam.show(at(X[j.body], j.place)), name: j.name });
    return { spots, mesh };
  }

  const number = x => Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5 || x === 0 ? x.toPrecision(4) : x.toExponential(2);
  const ENERGY = ['#1b6ca8', '#d9822b', '#3f8f5b'];
  function series(kind, k) { return kind < 2 ? energies[KINDS * k + kind] : energies[KINDS * k] + energies[KINDS * k + 1]; }

  // The strip under the picture: T, U and T + U, events, and where we are.
  function strip(ctx, w, h, t) {
    let low = Infinity, high = -Infinity;
    for (let k = 0; k < frames; k++) for (let kind = 0; kind < 3; kind++) { const x = series(kind, k); if (x < low) low = x; if (x > high) high = x; }
    const ends = [low, high];
    const span = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? high - low : 1;
    const X = s => (s - first) / (last - first || 1) * (w - 2) + 1, Y = e => h - 4 - (e - low) / span * (h - 8);
    ctx.clearRect(0, 0, w, h);
    if (low <= 0 && high >= 0) { ctx.strokeStyle = '#aab'; ctx.lineWidth = 1; ctx.beginPath(); ctx.moveTo(0, Y(0)); ctx.lineTo(w, Y(0)); ctx.stroke(); }
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
  const state = { t: first, playing: true, before: null, spots: [], pointer: null };
  const shown = () => ({ boxes: $('boxes').checked, sticks: $('sticks').checked, follow: $('follow').checked });
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
  function show() {
    const { spots, mesh } = draw(...fitted(view), state.t, shown());
    state.spots = spots;
    strip(...fitted(stripCanvas), state.t);
    $('numbers').textContent = readout(state.t);
    $('note').textContent = `${motion.note}; squares of the ground ${Number(mesh.toPrecision(3))} m`;
    scrub.value = state.t;
    play.textContent = state.playing ? 'Pause' : 'Play';
  }
  function tick(now) {
    if (state.playing && state.before !== null) {
      state.t += (now - state.before) / 1000 * Number($('speed').value);
      if (state.t >= last) { if ($('loop').checked && last > first) state.t = first + (state.t - first) % (last - first); else { state.t = last; state.playing = false; } following = null; }
    }
    state.before = now;
    show();
    requestAnimationFrame(tick);
  }
  const go = t => { state.t = Math.min(last, Math.max(first, t)); following = null; };
  const toggle = () => { if (!state.playing && state.t >= last) go(first); state.playing = !state.playing; };
  play.onclick = toggle;
  $('home').onclick = whole;
  scrub.oninput = () => { state.playing = false; go(Number(scrub.value)); };
  const strike = e => { const box = stripCanvas.getBoundingClientRect(); state.playing = false; go(first + (e.clientX - box.left) / box.width * (last - first)); };
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
  const nearer = factor => { fitting = false; eye.distance = Math.min(1e3 * motion.radius, Math.max(1e-2 * motion.radius, eye.distance * factor)); };
  const spread = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  view.onpointerdown = e => { view.setPointerCapture(e.pointerId); pointers.set(e.pointerId, { x: e.clientX, y: e.clientY }); };
  view.onpointerup = view.onpointercancel = e => pointers.delete(e.pointerId);
  view.onpointerleave = () => { tip.hidden = true; };
  view.onpointermove = e => {
    const old = pointers.get(e.pointerId);
    if (!old) return name(e);
    fitting = false;
    const dx = e.clientX - old.x, dy = e.clientY - old.y, apart = pointers.size === 2 ? spread() : 0;
    pointers.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (pointers.size === 2) nearer(apart / (spread() || 1));
    else if (e.shiftKey || e.buttons & 6) {
      const cam = camera(view.clientWidth, view.clientHeight), scale = eye.distance / (1.5 * Math.min(view.clientWidth, open(view.clientHeight)));
      eye.target = add(eye.target, add(scaled(cam.right, -dx * scale), scaled(cam.top, dy * scale)));
    } else {
      eye.azimuth -= dx * 0.008;
      eye.elevation = Math.min(1.55, Math.max(-1.55, eye.elevation + dy * 0.008));
    }
  };
  view.addEventListener('wheel', e => { e.preventDefault(); nearer(Math.exp(e.deltaY * (e.deltaMode ? 0.05 : 0.0015))); }, { passive: false });
  view.oncontextmenu = e => e.preventDefault();
  function name(e) {
    const away = s => Math.hypot(s.at[0] - e.clientX, s.at[1] - e.clientY), near = state.spots.filter(s => away(s) < 14).sort((a, b) => away(a) - away(b))[0];
    tip.hidden = !near;
    if (near) { tip.textContent = near.name; tip.style.left = `${e.clientX + 14}px`; tip.style.top = `${e.clientY + 10}px`; }
  }
  window.addEventListener('resize', () => { if (fitting && !$('follow').checked) whole(); });
  whole();
  requestAnimationFrame(tick);
})();
