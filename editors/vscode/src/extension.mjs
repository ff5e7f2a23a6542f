// The extension: its commands and what starts them.
import { ProgressLocation, commands, window, workspace } from "vscode";
import { Cycle } from "./cycle.mjs";
import { Panel } from "./panel.mjs";
import { chooseRobot } from "./robot.mjs";
import { restartServer, stopServer } from "./server.mjs";
import { simulate, trace } from "./simulate.mjs";
import { openFile, remember, target } from "./target.mjs";

/**
 * Shows that something runs, and lets the user end it.
 * @template T
 * @param {(signal: AbortSignal) => Promise<T>} task
 */
function withProgress(task) {
  const options = { location: ProgressLocation.Notification, title: "joulepath: simulation", cancellable: true };
  return window.withProgress(options, (_, token) => {
    const abort = new AbortController();
    token.onCancellationRequested(() => abort.abort());
    return task(abort.signal);
  });
}

/** @param {unknown} error */
const text = (error) => (error instanceof Error ? error.message : String(error));

/** @param {import("vscode").ExtensionContext} context */
export function activate(context) {
  const cycle = new Cycle();
  /** @type {import("vscode").Uri | undefined} */
  let shown;

  const draw = async () => {
    const of = target(context, shown);
    if (of === undefined) {
      return;
    }
    panel.show({ type: "busy" });
    try {
      const traced = await withProgress((signal) => trace({ ...of, signal }));
      cycle.show(traced.report);
      panel.show({ type: "path", ...traced });
    } catch (error) {
      panel.show({ type: "error", text: text(error) });
    }
  };
  const panel = new Panel(context.extensionUri, draw);

  /** @param {import("vscode").Uri} [uri] */
  const showPath = async (uri) => {
    shown = uri ?? openFile();
    await draw();
  };

  const showCycle = async () => {
    const of = target(context, openFile());
    if (of === undefined) {
      return;
    }
    try {
      const { report } = await withProgress((signal) => simulate({ ...of, signal }));
      cycle.show(report);
    } catch (error) {
      void window.showErrorMessage(text(error));
    }
  };

  const restart = () => restartServer(context);

  remember(window.activeTextEditor);
  context.subscriptions.push(
    cycle,
    panel,
    commands.registerCommand("joulepath.showPath", showPath),
    commands.registerCommand("joulepath.showCycle", showCycle),
    commands.registerCommand("joulepath.chooseRobot", () => chooseRobot(context)),
    commands.registerCommand("joulepath.restart", restart),
    window.onDidChangeActiveTextEditor(remember),
    window.onDidChangeTextEditorSelection(({ textEditor }) => panel.follow(textEditor)),
    workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("joulepath")) {
        void restart();
      }
    }),
  );
  void restart();
}

export const deactivate = stopServer;
