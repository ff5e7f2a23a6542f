// Draws a scene on a canvas.

import { colour, share } from "./colour.mjs";

/**
 * @typedef {import("./projection.mjs").Spot} Spot
 * @typedef {object} Look
 * @property {"dark" | "light"} theme
 * @property {string} foreground
 * @property {string} faint
 * @property {string} font
 *
 * @typedef {object} Picture
 * @property {import("../src/trajectory.mjs").Path} path
 * @property {ReturnType<typeof import("./scene.mjs").scene>} scene
 * @property {import("./colour.mjs").Range} range
 * @property {Spot[]} spots the points of the path on the screen
 * @property {ReturnType<typeof import("./projection.mjs").projection>} project
 * @property {Set<number>} marked segments of the line at the cursor
 * @property {number} current the segment under the pointer, or -1
 */

/** Of a piece that is shorter on the screen, a dot is drawn, px. */
const DOT = 0.75;

/** @type {(context: CanvasRenderingContext2D, from: Spot, to: Spot) => void} */
function line(context, from, to) {
  context.beginPath();
  context.moveTo(from[0], from[1]);
  context.lineTo(to[0], to[1]);
  context.stroke();
}

/** @type {(context: CanvasRenderingContext2D, at: Spot, radius: number) => void} */
function dot(context, at, radius) {
  context.beginPath();
  context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  context.fill();
}

/** @type {(context: CanvasRenderingContext2D, picture: Picture, look: Look) => void} */
function drawGround(context, { scene, project }, { foreground, faint, font }) {
  context.lineWidth = 1;
  context.strokeStyle = faint;
  for (const { from, to } of scene.grid) {
    line(context, project(...from), project(...to));
  }
  context.strokeStyle = context.fillStyle = foreground;
  context.font = font;
  const { axis } = scene;
  const origin = project(0, 0, 0);
  for (const [name, to] of /** @type {const} */ ([
    ["x", project(axis, 0, 0)],
    ["y", project(0, axis, 0)],
    ["z", project(0, 0, axis)],
  ])) {
    line(context, origin, to);
    context.fillText(name, to[0] + 4, to[1] - 4);
  }
}

/** @type {(context: CanvasRenderingContext2D, picture: Picture, look: Look) => void} */
function drawPath(context, { path, range, spots, marked, current }, { theme, foreground }) {
  const depth = (/** @type {number} */ piece) => spots[piece][2] + spots[piece + 1][2];
  const order = [...path.power.keys()].sort((a, b) => depth(b) - depth(a));
  const isMarked = (/** @type {number} */ piece) => marked.has(path.owner[piece]) || path.owner[piece] === current;
  const piece = (/** @type {number} */ index, /** @type {number} */ width) => {
    const [from, to] = [spots[index], spots[index + 1]];
    context.lineWidth = width;
    if (Math.hypot(to[0] - from[0], to[1] - from[1]) >= DOT) {
      line(context, from, to);
    } else {
      dot(context, from, path.segments[path.owner[index]].wait ? width / 2 + 2 : width / 2);
    }
  };
  context.lineCap = "round";
  const chosen = order.filter(isMarked);
  // What is marked has a border and is above the rest.
  for (const [pieces, width, fixed] of /** @type {const} */ ([
    [order, 2.5, undefined],
    [chosen, 6.5, foreground],
    [chosen, 4, undefined],
  ])) {
    for (const index of pieces) {
      context.strokeStyle = context.fillStyle = fixed ?? colour(share(path.power[index], range), theme);
      piece(index, width);
    }
  }
}

/** @type {(context: CanvasRenderingContext2D, picture: Picture, look: Look) => void} */
export function draw(context, picture, look) {
  drawGround(context, picture, look);
  drawPath(context, picture, look);
}
