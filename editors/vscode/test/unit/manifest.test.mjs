import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { test } from "node:test";

const manifest = JSON.parse(await readFile(new URL("../../package.json", import.meta.url), "utf8"));
const extension = await readFile(new URL("../../src/extension.mjs", import.meta.url), "utf8");
const [walkthrough] = manifest.contributes.walkthroughs;

test("every command of the manifest is registered", () => {
  for (const { command } of manifest.contributes.commands) {
    assert.ok(extension.includes(`registerCommand("${command}"`), command);
  }
});

test("every step of the walk-through has its page", () => {
  assert.equal(walkthrough.steps.length, 4);
  for (const { media } of walkthrough.steps) {
    assert.ok(existsSync(new URL(`../../${media.markdown}`, import.meta.url)), media.markdown);
  }
});

test("versions of dependencies are exact", () => {
  for (const [name, version] of Object.entries(manifest.devDependencies)) {
    assert.match(version, /^\d+\.\d+\.\d+$/, name);
  }
});
