// The language server: started, stopped, started again.
import { LanguageClient } from "vscode-languageclient/node";
import { command } from "./command.mjs";
import { settings } from "./settings.mjs";

/** @type {LanguageClient | undefined} */
let client;
/** A start waits until the stop before it is done. */
let done = Promise.resolve();

/** @param {import("vscode").ExtensionContext} context */
async function start(context) {
  const file = command(context);
  if (file === undefined) {
    return;
  }
  const { robot, entry, inputs } = settings();
  client = new LanguageClient(
    "joulepath",
    "joulepath",
    { command: file, args: ["lsp"] },
    {
      documentSelector: [{ scheme: "file", language: "rapid" }],
      initializationOptions: { robot: robot || undefined, entry: entry || undefined, inputs },
    },
  );
  await client.start();
}

async function stop() {
  const running = client;
  client = undefined;
  await running?.stop();
}

/**
 * Stops the server if it runs, and starts it with the present settings. The client tells the user of failures.
 * @param {import("vscode").ExtensionContext} context
 */
export function restartServer(context) {
  const fresh = () => start(context).catch(() => {});
  done = done.then(stop).then(fresh, fresh);
  return done;
}

export function stopServer() {
  done = done.then(stop);
  return done;
}
