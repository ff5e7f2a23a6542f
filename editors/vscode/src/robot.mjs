// Lets the user choose a robot.
import { window, workspace } from "vscode";
import { command } from "./command.mjs";
import { run } from "./simulate.mjs";

/** @param {import("vscode").ExtensionContext} context */
export async function chooseRobot(context) {
  const binary = command(context);
  if (binary === undefined) {
    return;
  }
  const { stdout } = await run(binary, ["robots", "list", "--format", "json"], {});
  const placeHolder = "The robot that runs the program";
  const robot = await window.showQuickPick(/** @type {string[]} */ (JSON.parse(stdout).robots), { placeHolder });
  if (robot !== undefined) {
    const isGlobal = workspace.workspaceFolders === undefined;
    await workspace.getConfiguration("joulepath").update("robot", robot, isGlobal);
  }
}
