// Starts the language server of joulepath for RAPID files.
"use strict";

const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function activate() {
  const settings = workspace.getConfiguration("joulepath");
  const given = (key) => settings.get(key) || undefined;
  const server = { command: settings.get("path"), args: ["lsp"] };
  client = new LanguageClient("joulepath", "joulepath", server, {
    documentSelector: [{ scheme: "file", language: "rapid" }],
    initializationOptions: {
      robot: given("robot"),
      entry: given("entry"),
      inputs: settings.get("inputs"),
    },
  });
  return client.start();
}

function deactivate() {
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
