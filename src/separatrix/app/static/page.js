// Figures, clicks in a map, the cut of running-in, files that are dropped. All data come from this server.
"use strict";

const dark = window.matchMedia("(prefers-color-scheme: dark)");

// htmx takes up what it has put into the page some 20 ms later.
// A form that is sent before that would leave the page.
document.addEventListener("submit", (event) => {
  if (event.target.matches("[hx-get], [hx-post]")) htmx.process(event.target);
}, true);

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

// Make a part of the page like another one, and keep focus, caret, scroll and what is being typed.
function morph(old, now) {
  if (old.nodeType !== now.nodeType || old.nodeName !== now.nodeName || old.id !== now.id) {
    old.replaceWith(now);
    return;
  }
  if (old.nodeType !== Node.ELEMENT_NODE) {
    if (old.data !== now.data) old.data = now.data;
    return;
  }
  const kept = isEdited(old);
  for (const { name, value } of now.attributes) if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  for (const { name } of [...old.attributes]) {
    if (!now.hasAttribute(name) && !(name === "open" && old.nodeName === "DETAILS")) old.removeAttribute(name);
  }
  if (old.nodeName === "TEXTAREA") old.defaultValue = now.defaultValue;
  else {
    const children = [...now.childNodes];
    children.forEach((child, i) => (old.childNodes[i] ? morph(old.childNodes[i], child) : old.append(child)));
    while (old.childNodes.length > children.length) old.lastChild.remove();
  }
  if ("defaultValue" in old && !kept && old.value !== old.defaultValue && old.type !== "hidden") old.value = old.defaultValue;
  if (old.type === "checkbox" && !kept) old.checked = old.defaultChecked;
  if (old.nodeName === "SELECT" && !kept) for (const one of old.options) one.selected = one.defaultSelected;
}

const sent = new Map(); // field -> its value in the request that is under way

const now = (field) => (field.type === "checkbox" ? field.checked : field.value);

function given(field) { // the value that the server gave
  if (field.type === "checkbox") return field.defaultChecked;
  if (field.nodeName !== "SELECT") return field.defaultValue;
  return ([...field.options].find((one) => one.defaultSelected) || field.options[0]).value;
}

function isEdited(field) {
  const is = field.nodeName === "SELECT" || ("defaultValue" in field && field.type !== "hidden");
  return is && now(field) !== (sent.has(field) ? sent.get(field) : given(field));
}

function inPlace(event) {
  const { target, xhr } = event.detail;
  if (!event.detail.shouldSwap || !["editor", "jobs"].includes(target.id) || !target.firstElementChild) return;
  event.detail.shouldSwap = false;
  const { then } = event.detail.requestConfig.elt.dataset;
  const next = target.cloneNode(false);
  next.innerHTML = xhr.responseText;
  morph(target, document.adoptNode(next));
  for (const one of target.children) htmx.process(one); // the target itself keeps its queue of requests
  const field = then && document.querySelector(then);
  if (field) field.focus(); // that of a candidate which was added, or of the next one to add
}

function sending(event) {
  const { elt, requestConfig } = event.detail;
  const trigger = requestConfig.triggeringEvent && requestConfig.triggeringEvent.target;
  if (trigger && trigger.name === "unit" && !trigger.form.elements.value.value.trim()) {
    event.preventDefault(); // a unit chosen before its number
    return;
  }
  if (elt.matches(".field, .text") && ![...elt.elements].some(isEdited)) {
    event.preventDefault(); // Enter both changes and submits: sent again, it would wipe out what the server said
    return;
  }
  if (requestConfig.verb !== "get") message("");
  if (elt.matches(".field, .text")) for (const field of elt.elements) sent.set(field, now(field));
}

function ended(event) {
  if (event.detail.requestConfig.path.startsWith("/edit/")) sent.clear();
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
  document.body.addEventListener("htmx:beforeRequest", sending);
  document.body.addEventListener("htmx:beforeSwap", inPlace);
  document.body.addEventListener("htmx:afterRequest", ended);
  document.body.addEventListener("htmx:afterSettle", (event) => showAll(event.target));
  document.body.addEventListener("htmx:sendError", () => message("The server does not answer. Start it again: nothing that was finished is lost."));
});
