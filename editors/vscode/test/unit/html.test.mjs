import assert from "node:assert/strict";
import { test } from "node:test";
import { page } from "../../src/html.mjs";

test("only the script with the nonce may run", () => {
  const html = page({ script: "s.js", style: "s.css", source: "https://self", nonce: "abc" });
  assert.match(html, /content="default-src 'none'; style-src https:\/\/self; script-src 'nonce-abc'"/);
  assert.deepEqual(html.match(/<script[^>]*>/g), ['<script nonce="abc" src="s.js">']);
  assert.doesNotMatch(html, /style="/);
});
