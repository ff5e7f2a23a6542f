// What a command is about: the file or folder that it was called for, or the open file.
import { dirname } from "node:path";
import { commands, window, workspace } from "vscode";
import { command } from "./command.mjs";
import { programsOf } from "./program.mjs";
import { settings } from "./settings.mjs";

/** @typedef {Omit<import("./simulate.mjs").Run, "signal">} Target */

/**
 * While the view of the path has the focus, no editor is active.
 * @type {import("vscode").Uri | undefined}
 */
let latest;

/** @param {import("vscode").TextEditor | undefined} editor */
export function remember(editor) {
  if (editor?.document.languageId === "rapid" && editor.document.uri.scheme === "file") {
    latest = editor.document.uri;
    // The walk-through asks for it.
    void commands.executeCommand("setContext", "joulepath.hasProgram", true);
  }
}

/** The RAPID file that is open, or was last. */
export const openFile = () => latest;

/**
 * If there is nothing to run, tells the user and returns nothing.
 * @param {import("vscode").ExtensionContext} context
 * @param {import("vscode").Uri | undefined} uri
 * @returns {Target | undefined}
 */
export function target(context, uri) {
  if (uri === undefined) {
    void window.showInformationMessage("Open a RAPID module first.");
    return undefined;
  }
  const binary = command(context);
  if (binary === undefined) {
    return undefined;
  }
  const folder = workspace.getWorkspaceFolder(uri)?.uri.fsPath ?? dirname(uri.fsPath);
  return { binary, programs: programsOf(uri.fsPath, folder), settings: settings(uri), folder };
}
