// VS Code as a server, and Chromium that shows it.
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { launch } from "puppeteer-core";

const SERVER = new URL("node_modules/code-server/lib/vscode/out/server-main.js", import.meta.url).pathname;
const START_MS = 60_000;

/** @param {string} vsix the package of the extension */
export async function startCode(vsix) {
  const browser = await launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox"],
    defaultViewport: { width: 1500, height: 900 },
  });
  const root = await mkdtemp(join(tmpdir(), "joulepath-code-"));
  const extensions = join(root, "extensions");
  const common = [
    SERVER,
    "--accept-server-license-terms",
    "--extensions-dir",
    extensions,
    "--server-data-dir",
    join(root, "data"),
    "--user-data-dir",
    join(root, "user"),
  ];
  execFileSync(process.execPath, [...common, "--install-extension", vsix], { stdio: "ignore" });
  const serving = ["--host", "127.0.0.1", "--port", "0", "--without-connection-token", "--disable-workspace-trust"];
  const server = spawn(process.execPath, [...common, ...serving, "--telemetry-level", "off"], {
    stdio: ["ignore", "pipe", "ignore"],
    // Only the extension's own folder may have the command.
    env: { ...process.env, HOME: root },
  });
  const port = await listening(server);
  return {
    extensions,
    browser,
    address: `http://127.0.0.1:${port}/`,
    async stop() {
      await browser.close();
      const ended = once(server, "exit");
      server.kill();
      await ended;
      await rm(root, { recursive: true, force: true, maxRetries: 3 });
    },
  };
}

/** @param {import("node:child_process").ChildProcessByStdio<null, import("node:stream").Readable, null>} server */
async function listening(server) {
  const timer = setTimeout(() => server.kill(), START_MS);
  for await (const line of createInterface(server.stdout)) {
    const found = /agent listening on (\d+)/.exec(line);
    if (found !== null) {
      clearTimeout(timer);
      server.stdout.resume();
      return found[1];
    }
  }
  throw new Error("VS Code did not start");
}
