// Runs `joulepath simulate`.
import { execFile } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { readTrajectory, segments } from "./trajectory.mjs";

const MAX_OUTPUT_BYTES = 1 << 28;

/**
 * @typedef {object} Run
 * @property {string} binary the command
 * @property {string[]} programs what may be the program; the first that runs is taken
 * @property {import("./settings.mjs").Settings} settings
 * @property {string} folder the working folder
 * @property {AbortSignal} signal ends the run
 *
 * @typedef {object} Report what the command says of a program, as far as it is of use here
 * @property {string} robot
 * @property {string} entry
 * @property {number} cycle_s
 * @property {number} energy_j
 * @property {[number, number]} [energy_interval_j]
 * @property {import("./trajectory.mjs").Action[]} moves
 * @property {import("./trajectory.mjs").Action[]} waits
 *
 * @typedef {{ report: Report, notes: string }} Simulated
 * @typedef {Simulated & { path: import("./trajectory.mjs").Path }} Traced
 */

/**
 * @param {import("./settings.mjs").Settings} settings
 * @param {string} program
 */
export function simulateArguments({ robot, entry, inputs }, program) {
  return [
    "simulate",
    program,
    "--format",
    "json",
    ...(robot === "" ? [] : ["--robot", robot]),
    ...(entry === "" ? [] : ["--entry", entry]),
    ...inputs.flatMap((input) => ["--input", input]),
  ];
}

/**
 * @param {string} binary
 * @param {string[]} args
 * @param {{ cwd?: string, signal?: AbortSignal }} options
 * @returns {Promise<{ stdout: string, stderr: string }>} rejects with the text of standard error
 */
export function run(binary, args, options) {
  return new Promise((resolve, reject) => {
    execFile(binary, args, { ...options, maxBuffer: MAX_OUTPUT_BYTES }, (error, stdout, stderr) => {
      if (error === null) {
        resolve({ stdout, stderr });
      } else {
        reject(new Error(stderr.trim() || error.message));
      }
    });
  });
}

/**
 * Time and energy of a program.
 * @param {Run} of
 * @param {string[]} [extra] further arguments
 * @returns {Promise<Simulated>}
 */
export async function simulate({ binary, programs, settings, folder, signal }, extra = []) {
  let first;
  for (const program of programs) {
    try {
      const args = [...simulateArguments(settings, program), ...extra];
      const { stdout, stderr } = await run(binary, args, { cwd: folder, signal });
      return { report: JSON.parse(stdout), notes: stderr.trim() };
    } catch (error) {
      first ??= error;
    }
  }
  throw first;
}

/**
 * The same with the path of the tool.
 * @param {Run} of
 * @returns {Promise<Traced>}
 */
export async function trace(of) {
  const folder = await mkdtemp(join(tmpdir(), "joulepath-"));
  try {
    const file = join(folder, "trajectory.csv");
    const simulated = await simulate(of, ["--trajectory", file]);
    const actions = segments(simulated.report, of.folder);
    return { ...simulated, path: await readTrajectory(file, actions) };
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}
