// What is drawn: the path, the floor below it, and the axes of the base.

import { ballAround } from "./projection.mjs";

/**
 * @typedef {import("../src/trajectory.mjs").Path} Path
 * @typedef {[number, number, number]} Point
 * @typedef {{ from: Point, to: Point }} Line
 */

/** About how many meshes the floor has along its longer side. */
const MESHES = 10;

/**
 * The distance of the floor's lines: 1, 2 or 5 times a power of ten, m.
 * @param {number} size
 */
export function mesh(size) {
  const raw = size / MESHES;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * ([1, 2, 5].find((factor) => factor * power >= raw * (1 - 1e-9)) ?? 10);
}

/** @param {Path} path */
export function scene({ points }) {
  const ball = ballAround([0, 0, 0, ...points]);
  /** @type {(axis: number) => [number, number]} */
  const extent = (axis) => {
    const values = points.filter((_, index) => index % 3 === axis);
    return values.reduce(([least, most], value) => [Math.min(least, value), Math.max(most, value)], [0, 0]);
  };
  const [x, y, z] = [extent(0), extent(1), extent(2)];
  const step = mesh(Math.max(x[1] - x[0], y[1] - y[0], 0.1));
  const floor = Math.min(0, z[0]);
  /** @type {(of: [number, number]) => [number, number]} */
  const rounded = ([least, most]) => [Math.floor(least / step) - 1, Math.ceil(most / step) + 1];
  const [[left, right], [front, back]] = [rounded(x), rounded(y)];
  /** @type {Line[]} */
  const grid = [];
  for (let i = left; i <= right; i += 1) {
    grid.push({ from: [i * step, front * step, floor], to: [i * step, back * step, floor] });
  }
  for (let j = front; j <= back; j += 1) {
    grid.push({ from: [left * step, j * step, floor], to: [right * step, j * step, floor] });
  }
  return { ball, grid, step, axis: 2 * step };
}

/**
 * The segment before or after, or the first or last one.
 * @param {number} current -1: none
 * @param {number} by 1 or -1
 * @param {number} count
 */
export function neighbour(current, by, count) {
  if (count === 0) {
    return -1;
  }
  return current === -1 ? (by > 0 ? 0 : count - 1) : (current + by + count) % count;
}

/**
 * The segments that a line of a file makes.
 * @param {Path} path
 * @param {string} file
 * @param {number} line
 */
export function segmentsOf({ segments }, file, line) {
  const found = new Set();
  segments.forEach((segment, index) => {
    if (segment.line === line && segment.file === file) {
      found.add(index);
    }
  });
  return found;
}
