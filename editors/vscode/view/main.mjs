// The page of the view: what comes from the editor, and what the user does.
import { watts } from "../src/quantity.mjs";
import { colour, range } from "./colour.mjs";
import { draw } from "./draw.mjs";
import { hit } from "./hit.mjs";
import { look } from "./look.mjs";
import { FIRST, moved, projection, turned, zoomed } from "./projection.mjs";
import { neighbour, scene, segmentsOf } from "./scene.mjs";
import { segmentText, titleText } from "./text.mjs";

/** How far from a piece the pointer finds it, px. */
const REACH = 10;
/** A drag that is shorter is a click, px. */
const CLICK = 4;
const RAD_PER_PX = 0.008;
const KEY = { turn: 0.1, move: 24, zoom: 1.2 };
const ZOOM_PER_PX = 0.0015;

/** @typedef {{ postMessage(message: object): void, getState(): any, setState(state: object): void }} Editor */
const editor = /** @type {{ acquireVsCodeApi(): Editor }} */ (/** @type {unknown} */ (globalThis)).acquireVsCodeApi();

/** @param {string} id */
const element = (id) => /** @type {HTMLElement} */ (document.getElementById(id));
const canvas = /** @type {HTMLCanvasElement} */ (element("canvas"));
const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));

/** @type {import("./projection.mjs").Camera} */
let camera = editor.getState()?.camera ?? FIRST;
/** @type {Pick<import("./draw.mjs").Picture, "path" | "scene" | "range"> | undefined} */
let content;
let cursor = { file: "", line: 0 };
let marked = /** @type {Set<number>} */ (new Set());
let current = -1;
/** @type {import("./projection.mjs").Spot[]} */
let spots = [];
let isDue = false;

function paint() {
  isDue = false;
  const { clientWidth: width, clientHeight: height } = canvas;
  const dense = devicePixelRatio;
  canvas.width = Math.round(width * dense);
  canvas.height = Math.round(height * dense);
  if (content === undefined) {
    return;
  }
  context.scale(dense, dense);
  const project = projection(camera, content.scene.ball, { width, height });
  const { points } = content.path;
  spots = [];
  for (let at = 0; at < points.length; at += 3) {
    spots.push(project(points[at], points[at + 1], points[at + 2]));
  }
  draw(context, { ...content, spots, project, marked, current }, look());
}

function repaint() {
  if (!isDue) {
    isDue = true;
    requestAnimationFrame(paint);
  }
}

/** @param {import("./projection.mjs").Camera} next */
function lookFrom(next) {
  camera = next;
  editor.setState({ camera });
  repaint();
}

function showLegend() {
  if (content === undefined) {
    return;
  }
  const { theme } = look();
  const { least, most } = content.range;
  const stops = [0, 0.25, 0.5, 0.75, 1].map((at) => colour(at, theme));
  element("scale").style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  element("least").textContent = watts(least);
  element("middle").textContent = watts((least + most) / 2);
  element("most").textContent = watts(most);
  element("mesh").textContent = `Lines of the floor: ${Math.round(content.scene.step * 1000)} mm`;
}

/** @param {"busy" | "error" | "path"} what */
function showOnly(what) {
  element("failure").hidden = what !== "error";
  element("drawing").hidden = what !== "path";
  element("reset").hidden = what !== "path";
  element("current").hidden = what !== "path";
  element("remarks").hidden = true;
}

/** @param {number} segment or -1 */
function choose(segment) {
  if (segment !== current) {
    current = segment;
    const of = content?.path.segments[segment];
    element("current").textContent = of === undefined ? "" : segmentText(of);
    editor.postMessage({ type: "hover", segment: of === undefined ? undefined : segment });
    repaint();
  }
}

/** @param {import("../src/simulate.mjs").Traced} traced */
function showPath({ path, report, notes }) {
  content = { path, scene: scene(path), range: range(path.power) };
  current = -1;
  marked = segmentsOf(path, cursor.file, cursor.line);
  showOnly("path");
  const isEmpty = path.segments.length === 0;
  element("title").textContent = isEmpty ? `${report.entry} on ${report.robot}: nothing moves` : titleText(report);
  element("legend").hidden = path.power.length === 0;
  element("current").textContent = "";
  const remarks = element("remarks");
  remarks.hidden = notes === "";
  /** @type {HTMLElement} */ (remarks.querySelector("summary")).textContent = `Notes (${notes.split("\n").length})`;
  /** @type {HTMLElement} */ (remarks.querySelector("pre")).textContent = notes;
  showLegend();
  repaint();
}

addEventListener("message", ({ data }) => {
  if (data.type === "path") {
    showPath(data);
  } else if (data.type === "cursor") {
    cursor = data;
    marked = content === undefined ? new Set() : segmentsOf(content.path, data.file, data.line);
    repaint();
  } else if (data.type === "busy") {
    content = undefined;
    showOnly("busy");
    element("title").textContent = "The simulation runs …";
  } else if (data.type === "error") {
    showOnly("error");
    element("title").textContent = "No path";
    element("message").textContent = data.text;
  }
});

/** @type {{ x: number, y: number, way: number } | undefined} */
let drag;

canvas.addEventListener("pointerdown", (event) => {
  drag = { x: event.clientX, y: event.clientY, way: 0 };
  canvas.setPointerCapture(event.pointerId);
});

canvas.addEventListener("pointermove", (event) => {
  if (drag === undefined) {
    const piece = hit(spots, event.offsetX, event.offsetY, REACH);
    choose(piece === -1 ? -1 : (content?.path.owner[piece] ?? -1));
    const tip = element("tip");
    tip.hidden = current === -1;
    tip.textContent = element("current").textContent;
    const isRight = event.offsetX > canvas.clientWidth / 2;
    tip.style.left = isRight ? "auto" : `${event.offsetX + 14}px`;
    tip.style.right = isRight ? `${canvas.clientWidth - event.offsetX + 14}px` : "auto";
    tip.style.top = `${event.offsetY + 14}px`;
    return;
  }
  const [dx, dy] = [event.clientX - drag.x, event.clientY - drag.y];
  drag = { x: event.clientX, y: event.clientY, way: drag.way + Math.hypot(dx, dy) };
  lookFrom(event.shiftKey ? moved(camera, dx, dy) : turned(camera, dx * RAD_PER_PX, dy * RAD_PER_PX));
});

canvas.addEventListener("pointerup", () => {
  const isClick = drag !== undefined && drag.way < CLICK;
  drag = undefined;
  if (isClick && current !== -1) {
    editor.postMessage({ type: "reveal", segment: current });
  }
});

canvas.addEventListener("pointercancel", () => {
  drag = undefined;
});

canvas.addEventListener("pointerleave", () => {
  element("tip").hidden = true;
  choose(-1);
});

canvas.addEventListener(
  "wheel",
  (event) => {
    event.preventDefault();
    const [x, y] = [event.offsetX - canvas.clientWidth / 2, event.offsetY - canvas.clientHeight / 2];
    lookFrom(zoomed(camera, Math.exp(-event.deltaY * ZOOM_PER_PX), x, y));
  },
  { passive: false },
);

canvas.addEventListener("keydown", (event) => {
  /** @type {Record<string, [number, number]>} */
  const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  /** @type {Record<string, () => void>} */
  const keys = {
    "+": () => lookFrom(zoomed(camera, KEY.zoom)),
    "-": () => lookFrom(zoomed(camera, 1 / KEY.zoom)),
    0: () => lookFrom(FIRST),
    PageDown: () => choose(neighbour(current, 1, content?.path.segments.length ?? 0)),
    PageUp: () => choose(neighbour(current, -1, content?.path.segments.length ?? 0)),
    Enter: () => editor.postMessage({ type: "reveal", segment: current }),
  };
  const way = ways[event.key];
  if (way !== undefined) {
    const [right, down] = way;
    lookFrom(
      event.shiftKey
        ? moved(camera, right * KEY.move, down * KEY.move)
        : turned(camera, right * KEY.turn, down * KEY.turn),
    );
  } else if (keys[event.key] !== undefined) {
    keys[event.key]();
  } else {
    return;
  }
  event.preventDefault();
});

element("reset").addEventListener("click", () => lookFrom(FIRST));
element("again").addEventListener("click", () => editor.postMessage({ type: "again" }));
element("robot").addEventListener("click", () => editor.postMessage({ type: "robot" }));
new ResizeObserver(repaint).observe(canvas);
new MutationObserver(() => {
  showLegend();
  repaint();
}).observe(document.body, { attributeFilter: ["class"] });
showOnly("busy");
editor.postMessage({ type: "ready" });
