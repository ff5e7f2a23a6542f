import assert from "node:assert/strict";
import { mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { programsOf } from "../../src/program.mjs";

test("the backup around a file, or the files around it, or the file", async (t) => {
  const root = await mkdtemp(join(tmpdir(), "joulepath-test-"));
  t.after(() => rm(root, { recursive: true }));
  const folder = join(root, "backup", "RAPID");
  const file = join(folder, "Main.mod");
  await mkdir(folder, { recursive: true });
  await writeFile(file, "");
  assert.deepEqual(programsOf(folder, root), [folder]);
  assert.deepEqual(programsOf(file, root), [folder, file]);
  await mkdir(join(root, "backup", "BACKINFO"));
  assert.deepEqual(programsOf(file, root), [join(root, "backup")]);
  assert.deepEqual(programsOf(file, folder), [folder, file], "a folder that is not open");
});
