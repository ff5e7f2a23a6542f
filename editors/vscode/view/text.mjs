// What the view says in words.
import { joules, seconds, watts } from "../src/quantity.mjs";

/** @param {import("../src/trajectory.mjs").Segment} segment */
export function segmentText({ instruction, file, line, duration_s, energy_j }) {
  const name = file.split(/[\\/]/).at(-1);
  return `${instruction}, ${name} line ${line}: ${seconds(duration_s)}, ${joules(energy_j)}, ${watts(energy_j / duration_s)} on average`;
}

/** @param {import("../src/simulate.mjs").Report} report */
export function titleText({ robot, entry, cycle_s, energy_j }) {
  return `${entry} on ${robot}: ${seconds(cycle_s)}, ${joules(energy_j)}`;
}
