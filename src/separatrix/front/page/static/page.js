// Figures, and parts of the page that are replaced in place. All data come from this server.
"use strict";

const dark = window.matchMedia("(prefers-color-scheme: dark)");

function looks() {
  const style = getComputedStyle(document.documentElement);
  const of = (name) => style.getPropertyValue(name).trim();
  return { paper_bgcolor: of("--paper"), plot_bgcolor: of("--paper"), font: { color: of("--ink"), family: "inherit" } };
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

async function fetched(place) {
  const response = await fetch(place, { headers: { "HX-Request": "true" } });
  if (response.ok) return response.json();
  const page = new DOMParser().parseFromString(await response.text(), "text/html");
  const words = [...page.querySelectorAll(".refusal p")].map((one) => one.textContent).join(" ");
  throw new Error(words || `The server answered ${response.status}.`);
}

async function show(figure) {
  try {
    const found = await fetched(figure.dataset.source);
    const options = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"] };
    await Plotly.react(figure.querySelector(".canvas"), found.data, { ...found.layout, ...looks() }, options);
  } catch (error) {
    message(error.message);
  }
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
  const next = target.cloneNode(false);
  next.innerHTML = xhr.responseText;
  morph(target, document.adoptNode(next));
  for (const one of target.children) htmx.process(one); // the target itself keeps its queue of requests
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

document.addEventListener("DOMContentLoaded", () => {
  for (const figure of document.querySelectorAll(".plot")) show(figure);
  dark.addEventListener("change", () => {
    for (const canvas of document.querySelectorAll(".plot .canvas")) if (canvas.data) Plotly.relayout(canvas, looks());
  });
  document.body.addEventListener("htmx:beforeRequest", sending);
  document.body.addEventListener("htmx:beforeSwap", inPlace);
  document.body.addEventListener("htmx:afterRequest", ended);
  document.body.addEventListener("htmx:sendError", () => message("The server does not answer. Start it again: nothing that was finished is lost."));
});
