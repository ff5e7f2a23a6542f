import assert from "node:assert/strict";
import { test } from "node:test";
import { run, simulate, simulateArguments } from "../../src/simulate.mjs";

const settings = { path: "", robot: "IRB1600-10/1.45", entry: "rWork", inputs: ["a=1", "b=2"] };
const { signal } = new AbortController();

test("settings become options", () => {
  assert.deepEqual(
    simulateArguments(settings, "cell"),
    "simulate cell --format json --robot IRB1600-10/1.45 --entry rWork --input a=1 --input b=2".split(" "),
  );
  assert.deepEqual(simulateArguments({ path: "", robot: "", entry: "", inputs: [] }, "cell"), [
    "simulate",
    "cell",
    "--format",
    "json",
  ]);
});

test("a failure has the text of standard error", async () => {
  const script = "console.error('error: no robot'); process.exit(2)";
  await assert.rejects(run(process.execPath, ["-e", script], {}), { message: "error: no robot" });
});

test("the first failure counts if no program runs", async () => {
  const of = { binary: process.execPath, programs: ["one", "two"], settings, folder: ".", signal };
  await assert.rejects(simulate(of), /simulate/);
});
