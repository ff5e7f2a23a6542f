// What is under the pointer.

/** @typedef {import("./projection.mjs").Spot} Spot */

/** @type {(px: number, py: number, a: Spot, b: Spot) => number} */
export function distance(px, py, [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const squared = dx * dx + dy * dy;
  const at = squared === 0 ? 0 : Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / squared));
  return Math.hypot(px - ax - at * dx, py - ay - at * dy);
}

/**
 * The piece that is nearest to the pointer, or -1. Of pieces that are as near on the screen, the one in front.
 * @param {Spot[]} spots the ends of the pieces: piece k joins the spots k and k + 1
 * @param {number} x
 * @param {number} y
 * @param {number} reach px
 */
export function hit(spots, x, y, reach) {
  let best = -1;
  let bestDistance = reach;
  let bestDepth = Infinity;
  for (let piece = 0; piece + 1 < spots.length; piece += 1) {
    const [from, to] = [spots[piece], spots[piece + 1]];
    const away = distance(x, y, from, to);
    const depth = (from[2] + to[2]) / 2;
    if (away < bestDistance - 0.5 || (away < bestDistance + 0.5 && away <= reach && depth < bestDepth)) {
      [best, bestDistance, bestDepth] = [piece, away, depth];
    }
  }
  return best;
}
