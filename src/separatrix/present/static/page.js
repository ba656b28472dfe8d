"use strict";
// Places of a figure that a reader can point at; figures may come after the page.
const tip = document.getElementById("tip");
const isPlace = (one) => one instanceof Element && one.matches(".paper circle");
const show = (circle) => {
  const at = circle.getBoundingClientRect();
  tip.textContent = circle.getAttribute("aria-label");
  tip.hidden = false;
  const left = Math.min(at.right + 8, window.innerWidth - tip.offsetWidth - 8);
  const above = at.top - tip.offsetHeight - 8;
  tip.style.left = Math.max(8, left) + "px";
  tip.style.top = (above > 0 ? above : at.bottom + 8) + "px";
};
for (const kind of ["pointerover", "focusin"]) {
  document.addEventListener(kind, ({ target }) => { if (isPlace(target)) show(target); });
}
for (const kind of ["pointerout", "focusout"]) document.addEventListener(kind, () => { tip.hidden = true; });
document.addEventListener("keydown", (event) => {
  const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
  if (event.key === "Escape") tip.hidden = true;
  if (!step || !isPlace(event.target)) return;
  const circles = [...event.target.parentElement.querySelectorAll("circle")];
  const now = circles.indexOf(event.target);
  const next = circles[(now + step + circles.length) % circles.length];
  circles[now].tabIndex = -1;
  next.tabIndex = 0;
  next.focus();
  event.preventDefault();
});
