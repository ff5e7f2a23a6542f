// The package in VS Code: from a missing command to the path of a program.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { cp, mkdir, mkdtemp, readdir, rm, symlink, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { joules, seconds } from "../../src/quantity.mjs";
import { startCode } from "./code.mjs";
import { Workbench } from "./workbench.mjs";

const FOLDER = new URL("../../", import.meta.url).pathname;
const FIXTURE = join(FOLDER, "../../fixtures/pick_place");
const BINARY = process.env.JOULEPATH ?? "";

/** @type {Awaited<ReturnType<typeof startCode>>} */
let code;
/** @type {string} */
let program;
/** @type {Workbench} */
let workbench;

before(async () => {
  const vsix = (await readdir(FOLDER)).find((name) => name.endsWith(".vsix"));
  assert.ok(vsix !== undefined, "npm run package makes the package");
  program = await mkdtemp(join(tmpdir(), "joulepath-program-"));
  await cp(FIXTURE, program, { recursive: true });
  await writeFile(join(program, "joulepath.toml"), 'robot = "IRB1600-10/1.45"\n');
  code = await startCode(join(FOLDER, vsix));
  workbench = new Workbench(await code.browser.newPage());
  await workbench.open(code.address, program);
});

after(async () => {
  await code.stop();
  await rm(program, { recursive: true });
});

test("without the command, a message offers help", async () => {
  await workbench.openFile("PickPlace.mod");
  await workbench.textIn(".notifications-toasts", "The command joulepath is neither in the extension");
  await workbench.textIn(".notifications-toasts", "Open settings");
  await workbench.textIn(".notifications-toasts", "How to install");
  await workbench.run("Notifications: Clear All Notifications");
});

test("the command in the folder of the platform serves the editor", async () => {
  const [installed] = (await readdir(code.extensions)).filter((name) => name.startsWith("joulepath."));
  const folder = join(code.extensions, installed, "bin", `${process.platform}-${process.arch}`);
  await mkdir(folder, { recursive: true });
  await symlink(BINARY, join(folder, "joulepath"));
  await workbench.run("joulepath: restart the server");
  // The other modules of the fixture have no findings.
  await workbench.openFile("Machine.mod");
  await workbench.page.waitForSelector(".squiggly-warning, .squiggly-info, .squiggly-hint", { timeout: 30_000 });
  await workbench.openFile("PickPlace.mod");
});

test("the path is drawn beside the text, with the cycle that the command reports", async () => {
  await workbench.run("joulepath: show the path");
  const view = await workbench.view();
  const report = JSON.parse(execFileSync(BINARY, ["simulate", program, "--format", "json", "-q"]).toString());
  const title = await view.says("title", "main on");
  assert.equal(title, `main on IRB1600-10/1.45: ${seconds(report.cycle_s)}, ${joules(report.energy_j)}`);
  await workbench.statusHas(`${joules(report.energy_j)} · ${seconds(report.cycle_s)}`);
  await view.picture();
  assert.ok((await view.colours()) > 50);
  await view.says("least", "^\\d+ W$");
  await view.says("most", "^\\d+ W$");
});

test("a click on a movement goes to its line", async () => {
  const view = await workbench.view();
  const tip = await view.pointAtMovement();
  const [, file, line] = /, (\w+\.\w+) line (\d+):/.exec(tip) ?? [];
  await workbench.page.mouse.down();
  await workbench.page.mouse.up();
  await workbench.page.waitForSelector(`.tab.active[data-resource-name="${file}"]`, { timeout: 30_000 });
  await workbench.textIn(".line-numbers.active-line-number", String(line));
});

test("the movements of the cursor's line are marked", async () => {
  const view = await workbench.view();
  await workbench.showTab("PickPlace.mod");
  await workbench.goTo(1);
  const plain = await view.picture();
  await workbench.goTo(13);
  await view.frame.waitForFunction(
    (before) => /** @type {HTMLCanvasElement} */ (document.getElementById("canvas")).toDataURL() !== before,
    { timeout: 10_000 },
    plain,
  );
});

test("keys turn the scene and step through the movements", async () => {
  const view = await workbench.view();
  await view.focus();
  const first = await view.picture();
  await workbench.page.keyboard.press("ArrowLeft");
  assert.notEqual(await view.picture(), first);
  await workbench.page.keyboard.press("0");
  assert.equal(await view.picture(), first);
  await workbench.page.keyboard.press("PageDown");
  await view.says("current", "line \\d+");
});

test("a simulation that fails shows its message", async () => {
  const view = await workbench.view();
  await writeFile(join(program, "joulepath.toml"), 'robot = "none"\n');
  await view.press("again");
  await view.says("message", "none");
  await writeFile(join(program, "joulepath.toml"), 'robot = "IRB1600-10/1.45"\n');
});

test("a program without movements has an empty path", async () => {
  const view = await workbench.view();
  for (const name of await readdir(program)) {
    if (/\.(mod|sys)$/.test(name) && name !== "PickPlace.mod") {
      await rm(join(program, name));
    }
  }
  await writeFile(join(program, "PickPlace.mod"), "MODULE PickPlace\n  PROC main()\n  ENDPROC\nENDMODULE\n");
  await view.press("again");
  await view.says("title", "nothing moves");
});
