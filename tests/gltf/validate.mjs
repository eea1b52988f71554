// SPDX-License-Identifier: MIT
// glTF files enter as arguments; a line for each leaves: how many errors Khronos's validator finds in it, and its name.
// MODULES: the folder with npm's packages.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { basename, dirname, join } from 'node:path';

const validator = createRequire(join(process.env.MODULES, '/'))('gltf-validator');

for (const file of process.argv.slice(2)) {
  const externalResourceFunction = async (uri) => new Uint8Array(await readFile(join(dirname(file), decodeURIComponent(uri))));
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), { uri: basename(file), externalResourceFunction });
  console.log(`${report.issues.numErrors} ${file}`);
}
