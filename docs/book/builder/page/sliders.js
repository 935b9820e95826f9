// Sliders for q, v and a of a robot. Generated C, as WebAssembly, computes torques, energies and
// placements.
'use strict';
(() => {
  const SVG = 'http://www.w3.org/2000/svg', SIDE = 260, NAMES = ['q', 'v', 'a'];
  const make = (name, attributes = {}, ...children) => {
    const e = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    e.append(...children);
    return e;
  };
  const drawn = (name, attributes) => {
    const e = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    return e;
  };
  const number = x => (Math.abs(x) < 5e-4 ? 0 : x).toFixed(3).replace('-', '\u2212');
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

  // Lines and discs of the links; gives what moves them to these placements.
  function picture(svg, { bodies, view, reach }) {
    const scale = 0.46 * SIDE / reach, at = p => view.map((axis, k) => SIDE / 2 + (k ? -1 : 1) * scale * dot(axis, p));
    svg.append(drawn('circle', { cx: SIDE / 2, cy: SIDE / 2, r: scale * reach, class: 'rest' }));
    const shapes = bodies.map(({ points, radius }) => {
      const width = Math.max(2 * scale * radius, 3);
      const shape = points.length > 1 ? drawn('line', { class: 'body', 'stroke-width': width }) : drawn('circle', { class: 'body', 'stroke-width': 0, r: width / 2 });
      svg.append(shape);
      return shape;
    });
    return placements => bodies.forEach(({ frame, points }, k) => {
      const X = placements.subarray(12 * frame, 12 * frame + 12);
      const [a, b] = points.map(p => at([0, 1, 2].map(i => dot(X.subarray(3 * i, 3 * i + 3), p) + X[9 + i])));
      const place = b ? { x1: a[0], y1: a[1], x2: b[0], y2: b[1] } : { cx: a[0], cy: a[1] };
      for (const [key, value] of Object.entries(place)) shapes[k].setAttribute(key, value.toFixed(2));
    });
  }

  async function start(figure) {
    const data = JSON.parse(figure.querySelector('script').textContent), { joints } = data, n = joints.length;
    const bytes = Uint8Array.from(atob(data.wasm), c => c.charCodeAt(0));
    const { exports } = (await WebAssembly.instantiate(bytes)).instance;
    const input = new Float64Array(exports.memory.buffer, exports.arguments(), 3 * n), results = new Float64Array(exports.memory.buffer, exports.results());

    const svg = drawn('svg', { viewBox: `0 0 ${SIDE} ${SIDE}`, role: 'img', 'aria-label': `${data.robot} in this configuration` });
    const show = picture(svg, data.drawing), controls = make('div'), shown = new Map();
    joints.forEach((joint, k) => {
      const group = make('fieldset', {}, make('legend', {}, joint.name));
      NAMES.forEach((name, kind) => {
        const [least, most] = joint.ranges[kind], slider = make('input', { type: 'range', min: least, max: most, step: 'any', name: `${name}.${joint.name}` });
        const value = make('output');
        slider.value = input[n * kind + k] = Math.min(most, Math.max(least, data.start[kind]));
        slider.addEventListener('input', () => { input[n * kind + k] = slider.valueAsNumber; update(); });
        shown.set(value, () => `${number(input[n * kind + k])} ${joint.units[kind].padEnd(6)}`);
        group.append(make('label', {}, name, slider, value));
      });
      controls.append(group);
    });
    const list = make('dl', { class: 'results' });
    const result = (title, name, value, unit) => {
      const out = make('output', { name });
      shown.set(out, () => `${number(value())} ${unit}`);
      list.append(make('div', {}, make('dt', {}, title), make('dd', {}, out)));
    };
    joints.forEach((joint, k) => result(`τ ${joint.name}`, `tau.${joint.name}`, () => results[k], joint.units[3]));
    result('kinetic T', 'kinetic', () => results[n], 'J');
    result('potential U', 'potential', () => results[n + 1], 'J');
    result('T + U', 'energy', () => results[n] + results[n + 1], 'J');
    controls.append(list);

    function update() {
      exports.run();
      for (const [output, text] of shown) output.textContent = text();
      show(results.subarray(n + 2));
    }
    figure.querySelector('.board').replaceChildren(svg, controls);
    update();
  }
  document.querySelectorAll('.sliders').forEach(start);
})();
