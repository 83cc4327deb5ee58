// Asks the WebAssembly module what the native program was asked, and holds its answers against the native ones.
// node wasm.mjs MODULE MODEL NATIVE: MODEL is a model file, NATIVE a folder with the native program's check.json and STUDY.csv.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { basename, dirname, join } from "node:path";

const [module, model, native] = process.argv.slice(2);
const compiled = new WebAssembly.Module(readFileSync(module));
assert.deepEqual(WebAssembly.Module.imports(compiled), [], "the core asks nothing of its host");
const core = new WebAssembly.Instance(compiled).exports;

function ask(work, request) {
  const bytes = new TextEncoder().encode(JSON.stringify(request));
  const at = core.request(bytes.length);
  new Uint8Array(core.memory.buffer, at, bytes.length).set(bytes);
  const status = core[work]();
  const answer = Buffer.from(core.memory.buffer, core.answer(), core.answer_length());
  return { ok: status === 0, answer: Buffer.from(answer) };
}

const folder = dirname(model);
const tables = readdirSync(folder).filter((name) => name.endsWith(".csv"));
const request = {
  text: readFileSync(model, "utf8"),
  title: basename(model, ".toml"),
  tables: Object.fromEntries(tables.map((name) => [name, readFileSync(join(folder, name), "utf8")])),
};

const check = ask("check", request);
assert.ok(check.ok, `check of ${model}: ${check.answer}`);
const { file, ...wanted } = JSON.parse(readFileSync(join(native, "check.json"), "utf8"));
assert.deepEqual(JSON.parse(check.answer), wanted, `check of ${file}`);

const studies = readdirSync(native).filter((name) => name.endsWith(".csv"));
assert.ok(studies.length > 0, `no native table of ${model}`);
for (const name of studies) {
  const run = ask("run", { ...request, study: basename(name, ".csv") });
  assert.ok(run.ok, `${name} of ${model}: ${run.answer}`);
  assert.ok(run.answer.equals(readFileSync(join(native, name))), `${name} of ${model} differs from the native bytes`);
}

const refused = ask("run", { ...request, study: "there is none such" });
assert.equal(refused.ok, false);
assert.equal(JSON.parse(refused.answer).diagnostics[0].code, "unknown-study");
console.log(`${model}: the check and ${studies.length} tables have the native bytes`);
