// The moving cage of one saved run: places and forces come from the server, movements enlarged as it says.
"use strict";

const INK = "#1b1f24", RACE = "#c9d1d9", BALL = "#8fa3b5", CAGE = "#E69F00", FORCE = "#D55E00", PATH = "#0072B2";
const WHOLE = 30; // seconds that the whole run takes at the usual speed

async function start(box) {
  const response = await fetch(box.dataset.source);
  if (!response.ok) return message("The run cannot be read.");
  const run = await response.json();
  const canvas = box.querySelector("canvas"), pen = canvas.getContext("2d");
  const play = document.getElementById("play"), moment = document.getElementById("moment");
  const speed = document.getElementById("speed"), enlarge = document.getElementById("enlarge");
  const forces = document.getElementById("forces"), reading = document.getElementById("reading");
  const last = run.time.length - 1, trace = traced(run, document.getElementById("trace"));
  let at = 0, playing = false, before = 0;
  moment.max = last;

  function show() {
    const index = Math.min(last, Math.round(at)), more = Number(enlarge.value);
    scene(pen, canvas.width, run, index, more, forces.checked);
    trace(index);
    moment.value = index;
    moment.setAttribute("aria-valuetext", `${(1e3 * run.time[index]).toFixed(1)} ms`);
    const force = Math.max(...run.force[index], run.land_force[index] || 0);
    reading.textContent = `${(1e3 * run.time[index]).toFixed(1)} ms of ${(1e3 * run.time[last]).toFixed(0)} ms; centre ` +
      `${(1e3 * run.true_offset[index]).toFixed(3)} mm off; largest force now ${force.toFixed(1)} N; movements ` +
      `${(run.enlarged * more).toPrecision(2)} times enlarged. In the end ${run.outcome}.`;
  }

  function step(now) {
    if (!playing) return;
    at += (Math.max(0, now - before) / 1e3 / WHOLE) * Number(speed.value) * last;
    before = Math.max(now, before); // a frame may have begun before the click
    if (at >= last) { at = last; toggle(); }
    show();
    if (playing) requestAnimationFrame(step);
  }

  function toggle() {
    playing = !playing;
    if (playing && at >= last) at = 0;
    play.textContent = playing ? "Pause" : "Play";
    play.setAttribute("aria-pressed", String(playing));
    before = performance.now();
    if (playing) requestAnimationFrame(step);
  }

  play.addEventListener("click", toggle);
  moment.addEventListener("input", () => { at = Number(moment.value); show(); });
  enlarge.addEventListener("input", show);
  forces.addEventListener("change", show);
  show();
  box.dataset.ready = "true";
}

function scene(pen, size, run, index, more, withForces) {
  const reach = 1 + 2.2 * run.half_width + run.ball, scale = (0.94 * size) / (2 * reach), middle = size / 2;
  const x = (value) => middle + scale * value, y = (value) => middle - scale * value;
  const circle = (cx, cy, radius) => { pen.beginPath(); pen.arc(x(cx), y(cy), scale * radius, 0, 2 * Math.PI); };
  pen.clearRect(0, 0, size, size);
  pen.lineWidth = 3;
  pen.strokeStyle = RACE;
  for (const radius of [1 - run.ball, 1 + run.ball]) { circle(0, 0, radius); pen.stroke(); }
  const [ox, oy] = run.offset[index].map((one) => more * one), turn = more * run.turn[index];
  pen.fillStyle = CAGE;
  pen.strokeStyle = INK;
  pen.lineWidth = 1;
  const count = run.angles.length, seat = Math.asin(run.ball), outside = run.land > 1 ? 1 : -1;
  const walls = run.walls.map((wall) => seat + more * (wall - seat)); // clearances grow with the movements
  const land = run.land && 1 + outside * (run.half_width + more * (Math.abs(run.land - 1) - run.half_width));
  for (let bar = 0; bar < count; bar += 1) {
    const next = (bar + 1) % count, lap = next === 0 ? 2 * Math.PI : 0;
    const from = run.angles[bar] + walls[bar] + turn, to = run.angles[next] + lap - walls[next] + turn;
    pen.beginPath();
    pen.arc(x(ox), y(oy), scale * (1 + run.half_width), -from, -to, true);
    pen.arc(x(ox), y(oy), scale * (1 - run.half_width), -to, -from, false);
    pen.closePath();
    pen.fill();
    pen.stroke();
  }
  if (run.land) { pen.strokeStyle = PATH; pen.lineWidth = 2; circle(0, 0, land); pen.stroke(); }
  run.angles.forEach((angle, ball) => {
    const place = angle + more * run.lead[index][ball], cx = Math.cos(place), cy = Math.sin(place);
    pen.fillStyle = BALL;
    pen.strokeStyle = INK;
    pen.lineWidth = 1;
    circle(cx, cy, run.ball);
    pen.fill();
    pen.stroke();
    const force = run.force[index][ball];
    if (withForces && force > 0 && run.largest_force > 0) {
      pen.strokeStyle = FORCE;
      pen.lineWidth = 2 + 6 * (force / run.largest_force);
      circle(cx, cy, run.ball * 1.12);
      pen.stroke();
    }
  });
  pen.fillStyle = INK;
  circle(0, 0, 0.008);
  pen.fill();
  pen.fillStyle = FORCE;
  circle(ox, oy, 0.016);
  pen.fill();
}

function traced(run, canvas) {
  const pen = canvas.getContext("2d"), width = canvas.width - 50, height = canvas.height - 30;
  const most = Math.max(...run.true_offset, 1e-12), last = run.time.length - 1;
  const x = (index) => 45 + (width * index) / last, y = (value) => 10 + height * (1 - value / most);
  return (index) => {
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.fillStyle = INK;
    pen.font = "11px sans-serif";
    pen.fillText(`${(1e3 * most).toPrecision(2)} mm`, 2, 16);
    pen.fillText("0", 34, height + 12);
    pen.fillText(`${(1e3 * run.time[last]).toPrecision(3)} ms`, width - 10, height + 26);
    pen.strokeStyle = PATH;
    pen.lineWidth = 1;
    pen.beginPath();
    run.true_offset.forEach((value, i) => (i ? pen.lineTo(x(i), y(value)) : pen.moveTo(x(i), y(value))));
    pen.stroke();
    pen.strokeStyle = FORCE;
    pen.beginPath();
    pen.moveTo(x(index), 10);
    pen.lineTo(x(index), 10 + height);
    pen.stroke();
  };
}

document.addEventListener("DOMContentLoaded", () => {
  const box = document.getElementById("cage");
  if (box) start(box);
});
