// Sliders of a study: numbers and figure at once from finished points; the curve is refined after a pause.
"use strict";

const REACH = 4; // a slider goes from a quarter of the study's value to four times it
const PAUSE = 1500, LOOK = 2000, PATIENCE = 600000; // milliseconds: before a curve is refined, between two looks at it, in all

document.addEventListener("DOMContentLoaded", () => {
  const box = document.getElementById("explore");
  if (!box) return;
  const figure = box.querySelector(".plot"), state = document.getElementById("state");
  const inputs = [...box.querySelectorAll("input[type=range]")];
  const begun = new Map(); // values whose curve was asked for -> when
  let asking = null, waiting = null, refining = null;

  const query = () => {
    const moved = inputs.filter((one) => Number(one.value) !== 0);
    return new URLSearchParams(moved.map((one) => [one.dataset.key, Number(one.dataset.value) * REACH ** Number(one.value)]));
  };

  async function update() {
    if (asking) asking.abort();
    asking = new AbortController();
    try {
      const found = await (await asked(`${box.dataset.source}?${query()}`, { signal: asking.signal })).json();
      for (const one of box.querySelectorAll("[data-number]")) one.textContent = found[one.dataset.number];
      for (const one of box.querySelectorAll("output")) one.textContent = found.values[one.dataset.of] || one.textContent;
      message("");
      if (found.figure) await draw(figure, found.figure.data, found.figure.layout);
      figure.hidden = !found.figure;
      say(found);
      box.dataset.updated = String(Date.now());
    } catch (error) {
      if (error.name !== "AbortError") message(error.message);
    }
  }

  function say(found) {
    if (!found.has_curve) state.textContent = "There is no curve yet: run stability or rank, then margin and threshold appear.";
    else if (!found.is_to_refine) state.textContent = found.outdated || "The curve belongs to these values.";
    else {
      const whose = found.outdated || "The curve is that of the study.";
      state.textContent = `${whose} It is computed for these values in the background.`;
      clearTimeout(refining);
      const values = String(query());
      if (!begun.has(values)) refining = setTimeout(refine, PAUSE, values);
      else if (begun.get(values) > Date.now() - PATIENCE) waiting = setTimeout(update, LOOK);
    }
  }

  async function refine(values) {
    begun.set(values, Date.now());
    try {
      await asked(`${box.dataset.refine}?${values}`, { method: "POST" });
      htmx.trigger(document.body, "refresh");
      waiting = setTimeout(update, LOOK);
    } catch (error) {
      message(error.message);
    }
  }

  for (const one of inputs) {
    one.addEventListener("input", () => {
      clearTimeout(waiting);
      clearTimeout(refining);
      update();
    });
  }
  document.getElementById("back").addEventListener("click", () => {
    for (const one of inputs) one.value = 0;
    update();
  });
  update();
});
