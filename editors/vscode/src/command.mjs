// The command `joulepath`: found, or an offer to help.
import { homedir } from "node:os";
import { commands, Uri, window } from "vscode";
import { findBinary } from "./binary.mjs";
import { settings } from "./settings.mjs";

const SETTINGS = "Open settings";
const INSTALL = "How to install";

/**
 * The file of the command. If there is none, tells the user and returns nothing.
 * @param {import("vscode").ExtensionContext} context
 */
export function command(context) {
  const setting = settings().path;
  const found = findBinary({
    setting,
    extension: context.extensionPath,
    home: homedir(),
    path: process.env.PATH ?? "",
    platform: process.platform,
    arch: process.arch,
  });
  if (found === undefined) {
    void offerHelp(context, setting);
  }
  return found;
}

/**
 * @param {import("vscode").ExtensionContext} context
 * @param {string} setting
 */
async function offerHelp(context, setting) {
  const text =
    setting === ""
      ? "The command joulepath is neither in the extension, nor in the PATH, nor in ~/.cargo/bin."
      : `The setting joulepath.path names no executable file: ${setting}`;
  const choice = await window.showErrorMessage(text, SETTINGS, INSTALL);
  if (choice === SETTINGS) {
    await commands.executeCommand("workbench.action.openSettings", "joulepath.path");
  } else if (choice === INSTALL) {
    const page = Uri.joinPath(context.extensionUri, "walkthrough", "install.md");
    await commands.executeCommand("markdown.showPreview", page);
  }
}
