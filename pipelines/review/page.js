"use strict";
// Corrections are lines of JSON, as docs/corrections.md has them. Nothing leaves the
// page but the file that is saved.
const SVG = "http://www.w3.org/2000/svg";
const form = document.getElementById("review");
const count = document.getElementById("count");

const numbers = (text) => text.trim().split(/\s+/).filter(Boolean).map((pair) => pair.split(",").map(Number));
const written = (points) => points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");

class Shape {
  constructor(group) {
    this.group = group;
    this.what = group.dataset.what;
    this.svg = group.ownerSVGElement;
    this.photo = group.closest("article").dataset.photo;
    this.polygon = group.querySelector("polygon");
    this.points = numbers(this.polygon.getAttribute("points"));
    this.first = written(this.points);
    this.draw();
  }

  get changed() {
    return this.points.length > 3 && written(this.points) !== this.first;
  }

  fresh() {
    const { width, height } = this.svg.viewBox.baseVal;
    const [left, right, top, bottom] = [0.25 * width, 0.75 * width, 0.1 * height, 0.85 * height];
    this.points = [[left, top], [right, top], [right, bottom], [left, bottom]];
    this.draw(0);
    told();
  }

  draw(focus = -1) {
    this.group.querySelectorAll("circle").forEach((one) => one.remove());
    this.points.forEach((_, place) => {
      const handle = document.createElementNS(SVG, "circle");
      handle.setAttribute("r", this.svg.viewBox.baseVal.width / 90);
      handle.setAttribute("tabindex", "0");
      handle.setAttribute("role", "button");
      handle.addEventListener("pointerdown", (event) => this.grab(event, handle, place));
      handle.addEventListener("keydown", (event) => this.key(event, place));
      this.group.append(handle);
    });
    this.place();
    if (focus >= 0) this.group.querySelectorAll("circle")[focus].focus();
  }

  place() {
    this.polygon.setAttribute("points", written(this.points));
    this.group.querySelectorAll("circle").forEach((handle, place) => {
      const [x, y] = this.points[place];
      handle.setAttribute("cx", x);
      handle.setAttribute("cy", y);
      const name = this.what === "quad" ? "corner" : "point";
      const where = `${name} ${place + 1} of ${this.points.length} of the ${this.what}`;
      handle.setAttribute("aria-label", `${where}, x ${Math.round(x)}, y ${Math.round(y)}`);
    });
  }

  move(place, x, y) {
    const { width, height } = this.svg.viewBox.baseVal;
    const beyond = this.what === "quad" ? 0.5 : 0; // a front may be cut off by its photo
    const within = (value, size) => Math.min(Math.max(value, -beyond * size), (1 + beyond) * size - 1);
    this.points[place] = [within(x, width), within(y, height)];
    this.place();
    told();
  }

  grab(event, handle, place) {
    event.preventDefault();
    handle.focus();
    handle.setPointerCapture(event.pointerId);
    const drag = (moved) => {
      const at = new DOMPoint(moved.clientX, moved.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
      this.move(place, at.x, at.y);
    };
    handle.addEventListener("pointermove", drag);
    const end = () => handle.removeEventListener("pointermove", drag);
    handle.addEventListener("pointerup", end, { once: true });
    handle.addEventListener("pointercancel", end, { once: true });
  }

  key(event, place) {
    const far = event.shiftKey ? 10 : 1;
    const [x, y] = this.points[place];
    const ways = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] };
    if (ways[event.key]) this.move(place, x + ways[event.key][0], y + ways[event.key][1]);
    else if (this.what === "mask" && (event.key === "Insert" || event.key === "+")) this.insert(place);
    else if (this.what === "mask" && event.key === "Delete" && this.points.length > 4) this.remove(place);
    else return;
    event.preventDefault();
  }

  insert(place) {
    const [[ax, ay], [bx, by]] = [this.points[place], this.points[(place + 1) % this.points.length]];
    this.points.splice(place + 1, 0, [(ax + bx) / 2, (ay + by) / 2]);
    this.draw(place + 1);
    told();
  }

  remove(place) {
    this.points.splice(place, 1);
    this.draw(place % this.points.length);
    told();
  }
}

const shapes = Array.from(document.querySelectorAll(".shape"), (group) => new Shape(group));

// Beside the newline, what ends a line for some programs, but not in JSON.
const escaped = (line) => line.replace(/[\u0085\u2028\u2029]/g, (one) => `\\u${one.charCodeAt(0).toString(16).padStart(4, "0")}`);

function corrections() {
  const drawn = shapes.filter((one) => one.changed);
  const lines = drawn.map((one) => [one.group, { photo: one.photo, what: one.what, value: written(one.points) }]);
  for (const input of form.querySelectorAll("input[data-what]")) {
    const { what, of, subject } = input.dataset;
    if (input.value.trim()) lines.push([input, { [of]: subject, what, value: input.value.trim() }]);
  }
  return lines.map(([element, line]) => {
    const note = element.closest("article").querySelector(".note").value.trim();
    return escaped(JSON.stringify(note ? { ...line, note } : line));
  });
}

function told() {
  const some = corrections().length;
  count.textContent = some ? `${some} ${some === 1 ? "correction" : "corrections"} to be saved` : "nothing is corrected yet";
}

form.addEventListener("input", told);
form.addEventListener("click", ({ target }) => {
  const article = target.closest("article");
  if (target.dataset.draw) shapes.find((one) => one.what === target.dataset.draw && article.contains(one.group)).fresh();
  if (target.dataset.take) {
    document.getElementById(target.dataset.into).value = target.dataset.take;
    told();
  }
});
form.addEventListener("submit", (event) => {
  event.preventDefault();
  const text = form.dataset.given + corrections().map((line) => `${line}\n`).join("");
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/jsonl" }));
  link.download = "corrections.jsonl";
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
});
