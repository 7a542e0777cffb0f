// SPDX-License-Identifier: GPL-3.0-or-later
"use strict";
for (const scene of document.querySelectorAll(".scene")) {
  const readout = scene.querySelector(".readout"), select = scene.querySelector("select");
  const points = [...scene.querySelectorAll(".point")];

  const show = (row) => {
    const chosen = [...select.options].find((option) => option.value === row);
    if (!chosen) return;
    select.value = row;
    scene.querySelector("img.picture").src = chosen.dataset.picture;
    scene.querySelector("img.errors").src = chosen.dataset.error;
    for (const point of points) point.classList.toggle("shown", point.dataset.select === row);
  };

  for (const point of points) {
    const tell = () => { readout.textContent = point.getAttribute("aria-label"); };
    point.addEventListener("mouseenter", tell);
    point.addEventListener("focus", tell);
    if (!select) continue;
    point.addEventListener("click", () => show(point.dataset.select));
    point.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      show(point.dataset.select);
    });
  }
  if (!select) continue;
  select.addEventListener("change", () => show(select.value));
  show(select.value);

  const wipe = scene.querySelector("input[type=range]");
  wipe.addEventListener("input", () => {
    scene.querySelector(".viewer").style.setProperty("--wipe", wipe.value + "%");
    scene.querySelector("output").textContent = wipe.value + " %";
  });
}
