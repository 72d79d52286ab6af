// Checks GLB files with the Khronos validator: node gltf-validate.mjs FILE.glb ...
// One line per file; exit status 1 if any file has an error or a warning, 2 on wrong usage.
// The validator is installed once into $GLTF_VALIDATOR_DIR, by default ~/.cache/gltf-validator.

import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir } from "node:os";
import { join } from "node:path";

const PACKAGE = "gltf-validator@2.0.0-dev.3.10";
const ERROR = 0;
const WARNING = 1;

function loadValidator() {
  const directory =
    process.env.GLTF_VALIDATOR_DIR ?? join(homedir(), ".cache", "gltf-validator");
  if (!existsSync(join(directory, "node_modules", "gltf-validator"))) {
    mkdirSync(directory, { recursive: true });
    const install = ["install", "--silent", "--no-audit", "--no-fund", "--prefix", directory];
    execFileSync("npm", [...install, PACKAGE], { stdio: ["ignore", "ignore", "inherit"] });
  }
  return createRequire(join(directory, "package.json"))("gltf-validator");
}

async function isValid(validator, path) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(path)));
  const { numErrors, numWarnings, numInfos, numHints, messages } = issues;
  console.log(
    `${path}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`,
  );
  for (const { severity, code, message, pointer } of messages) {
    const kind = { [ERROR]: "error", [WARNING]: "warning" }[severity] ?? "note";
    console.error(`  ${kind} ${code} at ${pointer ?? "the file"}: ${message}`);
  }
  return numErrors + numWarnings === 0;
}

const paths = process.argv.slice(2);
if (paths.length === 0) {
  console.error("usage: node gltf-validate.mjs FILE.glb ...");
  process.exit(2);
}
const validator = loadValidator();
let allValid = true;
for (const path of paths) {
  try {
    allValid = (await isValid(validator, path)) && allValid;
  } catch (error) {
    console.error(`${path}: ${error.message ?? error}`);
    allValid = false;
  }
}
process.exit(allValid ? 0 : 1);
