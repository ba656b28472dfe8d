// Figures, and parts of the page that are replaced in place. All data come from this server.
"use strict";

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

async function asked(place, options = {}) {
  const response = await fetch(place, { ...options, headers: { "HX-Request": "true" } });
  if (response.ok) return response;
  const page = new DOMParser().parseFromString(await response.text(), "text/html");
  const words = [...page.querySelectorAll(".refusal p")].map((one) => one.textContent).join(" ");
  throw new Error(words || `The server answered ${response.status}.`);
}

// A click in the first panel of a figure: a point of a map is simulated, running-in of a log ends there.
function chosen(event) {
  const paper = event.target.closest(":is([data-point], [data-cut]) .paper");
  if (!paper) return;
  const box = paper.getBoundingClientRect();
  const shares = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  const along = JSON.parse(paper.dataset.ways).map(([start, end], i) => (shares[i] - start) / (end - start));
  if (along.some((one) => one < 0 || one > 1)) return;
  const [x, y] = JSON.parse(paper.dataset.ways).map(([, , low, high, isLog], i) =>
    isLog ? low * (high / low) ** along[i] : low + (high - low) * along[i]);
  const { point, cut } = paper.closest(".answer").dataset;
  if (point) htmx.ajax("POST", point, { target: "#jobs", values: { x, y } });
  const field = document.getElementById("run-in");
  if (!cut || !field) return;
  field.value = `${Number(x.toPrecision(4))} ${cut}`;
  field.form.requestSubmit();
}

// Each fault of a text is written at its line, over the text.
function paint(code) {
  const [over, text] = code.children;
  const lines = text.value.split("\n");
  const faults = new Map();
  for (const one of code.parentElement.querySelectorAll("li[data-line]")) {
    faults.set(Number(one.dataset.line), [faults.get(Number(one.dataset.line)), one.dataset.short].filter(Boolean).join(" "));
  }
  over.style.transform = `translateY(${-text.scrollTop}px)`;
  over.replaceChildren(...lines.map((line, i) => {
    const row = document.createElement("div");
    row.dataset.number = i + 1;
    if (!faults.has(i + 1)) return row;
    row.className = "wrong";
    const words = document.createElement("span");
    words.textContent = faults.get(i + 1);
    words.style.marginLeft = `calc(${line.length + 2}ch - ${text.scrollLeft}px)`;
    row.append(words);
    return row;
  }));
}

function goTo(text, number) {
  const before = text.value.split("\n").slice(0, number - 1).join("\n").length + (number > 1);
  text.focus();
  text.setSelectionRange(before, before);
  text.scrollTop = (number - 5) * parseFloat(getComputedStyle(text).lineHeight);
}

async function upload(files) {
  const state = document.getElementById("uploaded");
  for (const file of files) {
    state.textContent = `Copying ${file.name} ...`;
    try {
      const response = await asked(`/logs/${encodeURIComponent(file.name)}`, { method: "PUT", body: file });
      document.getElementById("loglist").innerHTML = await response.text();
      state.textContent = `${file.name} is copied.`;
    } catch (error) {
      state.textContent = "";
      message(`${file.name}: ${error.message}`);
    }
  }
  if (files.length === 1 && state.textContent) location.assign(`/log/${encodeURIComponent(files[0].name)}`);
}

function dropping(place) {
  const over = (is) => (event) => {
    event.preventDefault();
    place.classList.toggle("hot", is);
  };
  place.addEventListener("dragover", over(true));
  place.addEventListener("dragleave", over(false));
  place.addEventListener("drop", (event) => {
    over(false)(event);
    upload(event.dataTransfer.files);
  });
  document.getElementById("pick").addEventListener("change", (event) => upload(event.target.files));
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
  if (!event.detail.shouldSwap || !["editor", "jobs", "map"].includes(target.id) || !target.firstElementChild) return;
  event.detail.shouldSwap = false;
  const active = target.querySelectorAll(".job.running, .job.waiting");
  const here = [...active].filter((one) => one.dataset.address === location.pathname).map((one) => one.id);
  const next = target.cloneNode(false);
  next.innerHTML = xhr.responseText;
  morph(target, document.adoptNode(next));
  for (const one of target.children) htmx.process(one); // the target itself keeps its queue of requests
  for (const code of target.querySelectorAll(".code")) paint(code);
  for (const id of here) if (!document.querySelector(`#${id}:is(.running, .waiting)`)) location.reload(); // its answer is shown
}

function sending(event) {
  const { elt, requestConfig } = event.detail;
  if (elt.matches(".field, .text") && ![...elt.elements].some(isEdited)) {
    event.preventDefault(); // Enter both changes and submits: sent again, it would wipe out what the server said
    return;
  }
  if (requestConfig.verb !== "get") message("");
  if (elt.matches(".field, .text")) for (const field of elt.elements) sent.set(field, now(field));
}

function ended(event) {
  if (event.detail.requestConfig.elt.matches(".field, .text")) sent.clear();
}

document.addEventListener("DOMContentLoaded", () => {
  for (const code of document.querySelectorAll(".code")) paint(code);
  for (const kind of ["input", "scroll"]) {
    document.body.addEventListener(kind, ({ target }) => target.id === "text" && paint(target.parentElement), true);
  }
  const place = document.getElementById("drop");
  if (place) dropping(place);
  document.body.addEventListener("click", ({ target }) => {
    if (target.matches(".at")) goTo(document.getElementById("text"), Number(target.dataset.line));
  });
  document.body.addEventListener("click", chosen);
  document.body.addEventListener("htmx:beforeRequest", sending);
  document.body.addEventListener("htmx:beforeSwap", inPlace);
  document.body.addEventListener("htmx:afterRequest", ended);
  document.body.addEventListener("htmx:sendError", () => message("The server does not answer. Start it again: nothing that was finished is lost."));
});
