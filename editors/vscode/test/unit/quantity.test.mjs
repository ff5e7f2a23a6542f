import assert from "node:assert/strict";
import { test } from "node:test";
import { joules, seconds, watts } from "../../src/quantity.mjs";

test("quantities have three digits and a unit", () => {
  assert.deepEqual([0, 4.567, 42.25, 999.4, 999.6, 21038.9, 123456].map(joules), [
    "0.00 J",
    "4.57 J",
    "42.3 J",
    "999 J",
    "1.00 kJ",
    "21.0 kJ",
    "123 kJ",
  ]);
  assert.deepEqual([0.164, 58.41].map(seconds), ["0.16 s", "58.4 s"]);
  assert.equal(watts(213.1), "213 W");
});
