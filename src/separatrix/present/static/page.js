"use strict";
const tip = document.getElementById("tip");
const show = (circle) => {
  const at = circle.getBoundingClientRect();
  tip.textContent = circle.getAttribute("aria-label");
  tip.hidden = false;
  const left = Math.min(at.right + 8, window.innerWidth - tip.offsetWidth - 8);
  const above = at.top - tip.offsetHeight - 8;
  tip.style.left = Math.max(8, left) + "px";
  tip.style.top = (above > 0 ? above : at.bottom + 8) + "px";
};
const hide = () => { tip.hidden = true; };
for (const svg of document.querySelectorAll(".paper svg")) {
  const circles = [...svg.querySelectorAll("circle")];
  for (const title of svg.querySelectorAll("title")) title.remove();
  svg.addEventListener("pointerover", (event) => { if (event.target.matches("circle")) show(event.target); });
  svg.addEventListener("pointerout", hide);
  svg.addEventListener("focusin", (event) => show(event.target));
  svg.addEventListener("focusout", hide);
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (event.key === "Escape") hide();
    if (!step) return;
    const now = circles.indexOf(event.target);
    const next = circles[(now + step + circles.length) % circles.length];
    circles[now].tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
    event.preventDefault();
  });
}
