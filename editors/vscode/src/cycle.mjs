// Time and energy of the cycle in the status bar.
import { StatusBarAlignment, window } from "vscode";
import { joules, seconds } from "./quantity.mjs";

export class Cycle {
  #item = window.createStatusBarItem("joulepath.cycle", StatusBarAlignment.Left);

  constructor() {
    this.#item.name = "joulepath: the cycle";
    this.#item.command = "joulepath.showCycle";
  }

  /** @param {import("./simulate.mjs").Report} report */
  show({ robot, entry, cycle_s, energy_j, energy_interval_j }) {
    const range = energy_interval_j === undefined ? "" : `, plausible ${energy_interval_j.map(joules).join(" to ")}`;
    this.#item.text = `$(zap) ${joules(energy_j)} · ${seconds(cycle_s)}`;
    this.#item.tooltip = `A cycle of ${entry} on ${robot}${range}. Click: simulate again.`;
    this.#item.show();
  }

  dispose() {
    this.#item.dispose();
  }
}
