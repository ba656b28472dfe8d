// The view of a run of a cage: its data in #run.
const run = JSON.parse(document.getElementById("run").textContent);
const at = (name) => document.getElementById(name), box = at("moving");
const Z = run.angles.length, N = run.time.length, R = run.radius, TAU = 2 * Math.PI;
const view = { high: run.view[0], around: run.view[1], zoom: 1 };
const RED = [213, 94, 0];
let frame = 0, playing = false, due = 0, grow = run.enlarged, faces = [];
at("time").max = N - 1;
at("grow").max = Math.max(2, 2 * run.enlarged);
at("grow").value = run.enlarged;

function outline(low, high, half, square, point) {
  const t = TAU * (point + 0.5) / run.around, c = Math.cos(t), s = Math.sin(t);
  const corner = square ? Math.max(Math.abs(c), Math.abs(s)) : 1;
  return [(low + high) / 2 + (high - low) / 2 * c / corner, half * s / corner];
}

function reach(j) {
  return Math.asin(Math.min(1, (run.ball + grow * run.plays[j]) / R));
}

function build() {
  faces = [];
  for (let j = 0; j < Z; j++) {
    const here = run.angles[j], after = j + 1 < Z ? run.angles[j + 1] : run.angles[0] + TAU;
    const before = j > 0 ? run.angles[j - 1] : run.angles[Z - 1] - TAU;
    const along = reach(j);
    const across = Math.min(run.ball + grow * run.axialPlay, run.rim * run.halfWidth);
    for (const side of [-1, 1]) {
      const r = R + side * run.halfThickness;
      const put = ([a, z]) => [r * Math.cos(a), r * Math.sin(a), z];
      for (let p = 0; p < run.around; p++) {
        const hole = (q) => put(outline(here - along, here + along, across, run.square, q));
        const edge = (q) => put(outline((here + before) / 2, (here + after) / 2, run.halfWidth, true, q));
        const light = 0.35 + 0.5 * Math.abs(Math.cos(here + (p / run.around - 0.5) * TAU / Z + 1.03));
        faces.push({ corners: [hole(p), hole(p + 1), edge(p + 1), edge(p)], light: light });
      }
    }
    const start = here + along, end = Math.max(start, after - reach((j + 1) % Z)); // the bar, in the plane of the balls
    const put = (i, side) => {
      const a = start + (end - start) * i / run.barPoints, r = R + side * run.halfThickness;
      return [r * Math.cos(a), r * Math.sin(a), 0];
    };
    for (let i = 0; i < run.barPoints; i++) {
      faces.push({ corners: [put(i, -1), put(i + 1, -1), put(i + 1, 1), put(i, 1)], light: 0.35 });
    }
  }
}

function place(f, [x, y, z]) {
  const cx = run.centre[2 * f], cy = run.centre[2 * f + 1], turn = run.rotation[f];
  const [lx, ly, axial] = run.lean ? [run.lean[2 * f], run.lean[2 * f + 1], run.axial[f]] : [0, 0, 0];
  return [x + grow * (cx + lx * z - turn * y) * 1e-9, y + grow * (cy + ly * z + turn * x) * 1e-9,
    z + grow * (axial - lx * x - ly * y) * 1e-9];
}

function eye(point, turn, scale, width, height) {
  const c = Math.cos(view.around + turn), s = Math.sin(view.around + turn);
  const across = c * point[0] - s * point[1], away = s * point[0] + c * point[1];
  const up = Math.cos(view.high) * point[2] + Math.sin(view.high) * away;
  return [width / 2 + scale * across, height / 2 - scale * up,
    Math.round(1e9 * (Math.sin(view.high) * point[2] - Math.cos(view.high) * away))];
}

function sized(canvas) {
  const dots = window.devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
  if (canvas.width !== Math.round(w * dots)) canvas.width = Math.round(w * dots);
  if (canvas.height !== Math.round(h * dots)) canvas.height = Math.round(h * dots);
  const pen = canvas.getContext("2d");
  pen.setTransform(dots, 0, 0, dots, 0, 0);
  pen.clearRect(0, 0, w, h);
  return [pen, w, h];
}

function draw() {
  const [pen, width, height] = sized(at("scene")), turn = at("fixed").checked ? run.turned[frame] : 0;
  const scale = view.zoom * Math.min(width, 1.2 * height) / (2.7 * (R + run.ball)), parts = [];
  for (const face of faces) {
    const seen = face.corners.map((corner) => eye(place(frame, corner), turn, scale, width, height));
    parts.push({ near: (seen[0][2] + seen[1][2] + seen[2][2] + seen[3][2]) / 4, seen: seen, light: face.light });
  }
  for (let j = 0; j < Z; j++) {
    const k = frame * Z + j, angle = run.angles[j] + grow * run.lead[k] * 1e-9 / R;
    const centre = [R * Math.cos(angle), R * Math.sin(angle), grow * (run.ballAxial ? run.ballAxial[k] : 0) * 1e-9];
    const seen = eye(centre, turn, scale, width, height);
    parts.push({ near: seen[2], ball: seen, share: Math.sqrt(run.force[k] / 255), first: j === 0 });
  }
  for (const h of run.heights) {
    const r = run.land + run.side * grow * run.gap;
    for (let i = 0; i < 90; i++) {
      const ends = [i, i + 1].map((n) => eye([r * Math.cos(n * TAU / 90), r * Math.sin(n * TAU / 90), h], turn,
        scale, width, height));
      parts.push({ near: (ends[0][2] + ends[1][2]) / 2, ring: ends });
    }
  }
  parts.sort((a, b) => a.near - b.near);
  for (const part of parts) paint(pen, part, scale);
  tell();
}

function paint(pen, part, scale) {
  pen.beginPath();
  if (part.seen) {
    part.seen.forEach((p, i) => (i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
    pen.closePath();
    const mix = (c) => Math.round(part.light * c + (1 - part.light) * 255);
    pen.fillStyle = pen.strokeStyle = `rgb(${mix(86)},${mix(180)},${mix(233)})`;
    pen.lineWidth = 0.6;
    pen.fill();
    pen.stroke();
  } else if (part.ball) {
    pen.arc(part.ball[0], part.ball[1], scale * run.ball, 0, TAU);
    pen.fillStyle = mixed(255, part.share);
    pen.fill();
    pen.strokeStyle = "#000";
    pen.lineWidth = part.first ? 2.5 : 1;
    pen.stroke();
  } else {
    pen.moveTo(part.ring[0][0], part.ring[0][1]);
    pen.lineTo(part.ring[1][0], part.ring[1][1]);
    pen.strokeStyle = mixed(107, Math.sqrt(run.landForce[frame] / 255));
    pen.lineWidth = 2.5;
    pen.stroke();
  }
}

function mixed(grey, share) {
  return `rgb(${RED.map((c) => Math.round(share * c + (1 - share) * grey)).join(",")})`;
}

function path(name, values, unit, limit) {
  const [pen, width, height] = sized(at(name)), turned = at("fixed").checked;
  let most = limit;
  for (let i = 0; i < values.length; i += 2) most = Math.max(most, Math.hypot(values[i], values[i + 1]) * unit);
  const scale = 0.43 * Math.min(width, height) / (most || 1);
  const spot = (f) => {
    const x = values[2 * f] * unit, y = values[2 * f + 1] * unit, a = turned ? run.turned[f] : 0;
    return [width / 2 + scale * (x * Math.cos(a) - y * Math.sin(a)),
      height / 2 - scale * (x * Math.sin(a) + y * Math.cos(a))];
  };
  pen.strokeStyle = "#bbb";
  pen.lineWidth = 1;
  pen.strokeRect(width / 2 - scale * most, height / 2 - scale * most, 2 * scale * most, 2 * scale * most);
  if (limit > 0) {
    pen.beginPath();
    pen.arc(width / 2, height / 2, scale * limit, 0, TAU);
    pen.strokeStyle = "#6b6b6b";
    pen.stroke();
  }
  for (const [first, colour, wide] of [[0, "#56B4E955", 0.6], [Math.max(0, frame - 60), "#0072B2", 1.4]]) {
    pen.beginPath();
    for (let f = first; f <= frame; f++) pen[f === first ? "moveTo" : "lineTo"](...spot(f));
    pen.strokeStyle = colour;
    pen.lineWidth = wide;
    pen.stroke();
  }
  pen.beginPath();
  pen.arc(...spot(frame), 3.5, 0, TAU);
  pen.fillStyle = "#0072B2";
  pen.fill();
  pen.fillStyle = "#444";
  pen.font = "11px sans-serif";
  pen.fillText("\u00b1" + most.toPrecision(2), 4, 12);
}

function tell() {
  const f = frame, size = (v) => Math.hypot(v[2 * f], v[2 * f + 1]);
  let force = 0;
  for (let j = 0; j < Z; j++) force = Math.max(force, run.force[f * Z + j]);
  const rows = [
    ["time", (1e3 * run.time[f]).toFixed(3) + " ms"],
    ["offset", (1e-3 * size(run.centre)).toFixed(1) + " \u00b5m"],
    ...(run.lean ? [["tilt", (1e-6 * size(run.lean)).toFixed(2) + " mrad"],
      ["axial place", (1e-3 * run.axial[f]).toFixed(1) + " \u00b5m"]] : []),
    ["rotation", (1e-6 * run.rotation[f]).toFixed(2) + " mrad"],
    ["largest pocket force", (force / 255 * run.most[0]).toPrecision(2) + " N"],
    ...(run.side ? [["land force", (run.landForce[f] / 255 * run.most[1]).toPrecision(2) + " N"]] : []),
  ];
  const body = at("readings");
  body.replaceChildren(...rows.map((row) => {
    const line = document.createElement("tr");
    for (const text of row) line.appendChild(document.createElement("td")).textContent = text;
    return line;
  }));
  path("orbit", run.centre, 1e-6, run.side ? 1e3 * run.gap : 0);
  if (run.lean) path("lean", run.lean, 1e-6, 0);
  at("time").value = frame;
  at("time").setAttribute("aria-valuetext", rows[0][1]);
  at("grown").textContent = "\u00d7 " + grow.toFixed(1);
}

function step(now) {
  if (!playing) return;
  if (now >= due) {
    const pace = 24 * Math.pow(2, Number(at("speed").value));
    frame = (frame + Math.max(1, Math.round(pace / 60))) % N;
    due = now + 1000 / Math.min(60, pace);
    draw();
  }
  requestAnimationFrame(step);
}

function play(on) {
  playing = on;
  at("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(step);
}

function show(f) {
  frame = Math.min(N - 1, Math.max(0, f));
  draw();
}

at("play").addEventListener("click", () => play(!playing));
at("time").addEventListener("input", () => { play(false); show(Number(at("time").value)); });
at("grow").addEventListener("input", () => { grow = Number(at("grow").value); build(); draw(); });
at("fixed").addEventListener("change", draw);
new ResizeObserver(draw).observe(at("scene"));
const turnBy = (across, up) => {
  view.around += across;
  view.high = Math.min(TAU / 4, Math.max(-TAU / 4, view.high + up));
  draw();
};
const zoomBy = (by) => { view.zoom = Math.min(20, Math.max(0.3, view.zoom * by)); draw(); };
at("scene").addEventListener("pointerdown", (event) => at("scene").setPointerCapture(event.pointerId));
at("scene").addEventListener("pointermove", (event) => {
  if (event.buttons) turnBy(0.008 * event.movementX, 0.008 * event.movementY);
});
at("scene").addEventListener("wheel", (event) => {
  event.preventDefault();
  zoomBy(Math.exp(-0.0015 * event.deltaY));
}, { passive: false });
const keys = {
  ArrowLeft: () => turnBy(-0.08, 0), ArrowRight: () => turnBy(0.08, 0),
  ArrowUp: () => turnBy(0, 0.08), ArrowDown: () => turnBy(0, -0.08),
  "+": () => zoomBy(1.15), "=": () => zoomBy(1.15), "-": () => zoomBy(1 / 1.15),
  " ": () => play(!playing), ",": () => { play(false); show(frame - 1); },
  ".": () => { play(false); show(frame + 1); },
  0: () => { Object.assign(view, { high: run.view[0], around: run.view[1], zoom: 1 }); draw(); },
};
document.addEventListener("keydown", (event) => {
  const element = event.target;
  if (element !== document.body && !box.contains(element)) return;
  if (element.tagName === "INPUT" || (element.tagName === "BUTTON" && event.key === " ")) return;
  if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(keys, event.key)) return;
  event.preventDefault();
  keys[event.key]();
});
at("tilting").hidden = !run.lean;
build();
draw();
