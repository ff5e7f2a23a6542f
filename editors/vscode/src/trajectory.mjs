// The path of the tool from the CSV file of `joulepath simulate --trajectory`.
import { createReadStream } from "node:fs";
import { resolve } from "node:path";
import { createInterface } from "node:readline";

/** About how many pieces a path has at most, beside one for each segment. */
const MAX_PIECES = 10_000;
/** The least duration of a piece that does not end its segment, s. */
const MIN_PIECE_S = 0.008;
/** A tool that moved less stands still, m. */
const STANDSTILL_M = 0.0005;

/**
 * @typedef {object} Action a movement or wait, as `simulate` reports it
 * @property {string} file
 * @property {number} line from 1
 * @property {string} instruction
 * @property {number} t_start_s
 * @property {number} duration_s
 * @property {number} energy_j
 *
 * @typedef {Action & { wait: boolean }} Segment
 *
 * @typedef {object} Path Piece k joins the points k and k + 1.
 * @property {Segment[]} segments in the order of time
 * @property {number[]} points x, y, z of each point in the frame of the base, m
 * @property {number[]} power mean electrical power of each piece, W
 * @property {number[]} owner the segment of each piece, by index
 */

/**
 * All movements and waits that take time, in their order.
 * @param {{ moves: Action[], waits: Action[] }} report
 * @param {string} folder that the names of files are relative to
 * @returns {Segment[]}
 */
export function segments({ moves, waits }, folder) {
  /** @param {boolean} wait @returns {(action: Action) => Segment} */
  const segment = (wait) => ({ file, line, instruction, t_start_s, duration_s, energy_j }) => ({
    file: resolve(folder, file),
    line,
    instruction,
    t_start_s,
    duration_s,
    energy_j,
    wait,
  });
  return [...moves.map(segment(false)), ...waits.map(segment(true))]
    .filter(({ duration_s }) => duration_s > 0)
    .sort((a, b) => a.t_start_s - b.t_start_s);
}

/**
 * Fewer points than samples: a piece ends with its segment, or when it is long enough and the tool moved.
 * @param {AsyncIterable<string> | Iterable<string>} lines of the CSV file
 * @param {Segment[]} segments
 * @returns {Promise<Path>}
 */
export async function thin(lines, segments) {
  /** @type {Path} */
  const path = { segments, points: [], power: [], owner: [] };
  const last = segments.at(-1);
  const pieceS = Math.max(MIN_PIECE_S, (last === undefined ? 0 : last.t_start_s + last.duration_s) / MAX_PIECES);
  /** @type {number[] | undefined} */
  let columns;
  let owner = 0;
  // Of the piece that has begun.
  let energy = 0;
  let start = 0;
  /** @type {number[] | undefined} */
  let previous;

  /** @param {number[]} sample */
  const endPiece = ([t, , x, y, z]) => {
    path.points.push(x, y, z);
    path.power.push(energy / (t - start));
    path.owner.push(owner);
    energy = 0;
    start = t;
  };

  for await (const line of lines) {
    const cells = line.split(",");
    if (columns === undefined) {
      columns = ["t", "p_elec", "tcp_x", "tcp_y", "tcp_z"].map((name) => cells.indexOf(name));
      continue;
    }
    const sample = columns.map((column) => Number(cells[column]));
    const [t, power, x, y, z] = sample;
    if (previous === undefined) {
      path.points.push(x, y, z);
      start = t;
    } else {
      energy += ((power + previous[1]) / 2) * (t - previous[0]);
      const end = segments[owner + 1]?.t_start_s ?? Infinity;
      const moved = Math.hypot(...path.points.slice(-3).map((value, axis) => value - sample[2 + axis]));
      if (t > start && (t >= end || (t - start >= pieceS && moved >= STANDSTILL_M))) {
        endPiece(sample);
      }
      while (t >= (segments[owner + 1]?.t_start_s ?? Infinity)) {
        owner += 1;
      }
    }
    previous = sample;
  }
  if (previous !== undefined && previous[0] > start) {
    endPiece(previous);
  }
  return path;
}

/**
 * @param {string} file
 * @param {Segment[]} segments
 */
export async function readTrajectory(file, segments) {
  return await thin(createInterface({ input: createReadStream(file), crlfDelay: Infinity }), segments);
}
