// Figures, clicks in a map, the cut of running-in, files that are dropped. All data come from this server.
"use strict";

const dark = window.matchMedia("(prefers-color-scheme: dark)");

function looks() {
  const style = getComputedStyle(document.documentElement);
  const of = (name) => style.getPropertyValue(name).trim();
  return { paper_bgcolor: of("--paper"), plot_bgcolor: of("--paper"), font: { color: of("--ink"), family: "inherit" } };
}

function draw(figure, data, layout) {
  const canvas = figure.querySelector(".canvas");
  const options = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"] };
  return Plotly.react(canvas, data, { ...layout, ...looks() }, options).then(() => canvas);
}

function message(text) {
  const box = document.getElementById("message");
  box.replaceChildren();
  if (text) {
    const line = document.createElement("p");
    line.className = "bad";
    line.textContent = text;
    box.append(line);
  }
}

async function answered(response) {
  if (response.ok) return response;
  const page = new DOMParser().parseFromString(await response.text(), "text/html");
  const words = [...page.querySelectorAll(".refusal p")].map((one) => one.textContent).join(" ");
  throw new Error(words || `The server answered ${response.status}.`);
}

const asked = (place, options = {}) =>
  fetch(place, { ...options, headers: { "HX-Request": "true", ...(options.headers || {}) } }).then(answered);

async function show(figure) {
  figure.dataset.shown = "true";
  try {
    const found = await (await asked(figure.dataset.source)).json();
    const canvas = await draw(figure, found.data, found.layout);
    if (figure.dataset.point) canvas.on("plotly_click", (event) => choose(figure.dataset.point, event.points[0]));
    if ("cut" in figure.dataset) canvas.on("plotly_click", (event) => cut(event.points[0].x, figure.dataset.cut));
  } catch (error) {
    message(error.message);
  }
}

function choose(place, point) {
  htmx.ajax("POST", place, { target: "#jobs", values: { x: point.x, y: point.y } });
}

function cut(at, unit) {
  const field = document.getElementById("run-in");
  field.value = `${Number(at.toPrecision(4))} ${unit || "cycles"}`.trim();
  field.form.requestSubmit();
}

function showAll(root) {
  if (typeof Plotly === "undefined") return;
  for (const figure of root.querySelectorAll(".plot[data-source]:not([data-shown])")) show(figure);
}

async function upload(files) {
  const state = document.getElementById("uploaded");
  for (const file of files) {
    state.textContent = `Copying ${file.name} ...`;
    try {
      const response = await asked(`/logs/${encodeURIComponent(file.name)}`, { method: "PUT", body: file });
      const list = document.getElementById("loglist");
      list.innerHTML = await response.text();
      htmx.process(list);
      state.textContent = `${file.name} is copied.`;
      htmx.ajax("GET", `/log/${encodeURIComponent(file.name)}`, { target: "#log" });
    } catch (error) {
      state.textContent = "";
      message(`${file.name}: ${error.message}`);
    }
  }
}

function dropping() {
  const place = document.getElementById("drop");
  if (!place) return;
  const over = (is) => (event) => {
    event.preventDefault();
    place.classList.toggle("over", is);
  };
  place.addEventListener("dragover", over(true));
  place.addEventListener("dragleave", over(false));
  place.addEventListener("drop", (event) => {
    over(false)(event);
    upload(event.dataTransfer.files);
  });
  document.getElementById("pick").addEventListener("change", (event) => upload(event.target.files));
}

document.addEventListener("DOMContentLoaded", () => {
  showAll(document);
  dropping();
  dark.addEventListener("change", () => {
    for (const canvas of document.querySelectorAll(".plot .canvas")) if (canvas.data) Plotly.relayout(canvas, looks());
  });
  // A draft keeps the field that was edited in focus after the form is drawn again.
  let focus = null;
  document.body.addEventListener("htmx:beforeSwap", () => {
    focus = document.activeElement && document.activeElement.id;
    message("");
  });
  document.body.addEventListener("htmx:afterSettle", (event) => {
    if (focus && document.getElementById(focus) && document.activeElement.id !== focus) document.getElementById(focus).focus();
    showAll(event.target);
  });
  document.body.addEventListener("htmx:sendError", () => message("The server does not answer. Start it again: nothing that was finished is lost."));
});
