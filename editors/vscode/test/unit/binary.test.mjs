import assert from "node:assert/strict";
import { chmod, mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { candidates, findBinary } from "../../src/binary.mjs";

/** @type {string} */
let root;
/** @type {import("../../src/binary.mjs").Place} */
let place;

before(async () => {
  root = await mkdtemp(join(tmpdir(), "joulepath-test-"));
  const [extension, home] = [join(root, "extension"), join(root, "home")];
  const path = [join(root, "one"), join(root, "two")].join(delimiter);
  place = { setting: "", extension, home, path, platform: "linux", arch: "x64" };
});

after(() => rm(root, { recursive: true }));

/** @param {string} file */
async function install(file) {
  await mkdir(dirname(file), { recursive: true });
  await writeFile(file, "");
  await chmod(file, 0o755);
}

test("nearer places win", async () => {
  assert.equal(findBinary(place), undefined);
  const places = [
    join(place.home, ".cargo", "bin", "joulepath"),
    join(root, "two", "joulepath"),
    join(root, "one", "joulepath"),
    join(place.extension, "bin", "linux-x64", "joulepath"),
  ];
  for (const file of places) {
    await install(file);
    assert.equal(findBinary(place), file);
  }
  await install(join(root, "two", "other"));
  assert.equal(findBinary({ ...place, setting: "other" }), join(root, "two", "other"));
});

test("a setting that names nothing finds nothing", () => {
  assert.equal(findBinary({ ...place, setting: join(root, "nothing") }), undefined);
  assert.equal(findBinary({ ...place, setting: root }), undefined, "a folder");
});

test("a setting may begin with the folder of the user", () => {
  assert.deepEqual(candidates({ ...place, setting: "~/bin/joulepath" }), [`${place.home}/bin/joulepath`]);
});

test("Windows has another name for it", () => {
  const [first] = candidates({ ...place, platform: "win32", arch: "arm64" });
  assert.equal(first, join(place.extension, "bin", "win32-arm64", "joulepath.exe"));
});
