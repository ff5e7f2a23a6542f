// The settings of the extension.
import { workspace } from "vscode";

/** @typedef {{ path: string, robot: string, entry: string, inputs: string[] }} Settings */

/**
 * @param {import("vscode").Uri} [scope]
 * @returns {Settings}
 */
export function settings(scope) {
  const all = workspace.getConfiguration("joulepath", scope);
  return {
    path: all.get("path", ""),
    robot: all.get("robot", ""),
    entry: all.get("entry", ""),
    inputs: all.get("inputs", []),
  };
}
