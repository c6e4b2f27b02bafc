// Validates GLB files with the Khronos glTF validator (npm's gltf-validator, found through NODE_PATH or next to
// this file). usage: validate_glb.mjs FILE...   Exit status: 1 where a file has an error or a warning, 77 where the
// validator is not installed.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';

let validator;
try {
    validator = createRequire(import.meta.url)('gltf-validator');
} catch {
    console.log('skipped: npm package gltf-validator is not installed');
    process.exit(77);
}
const paths = process.argv.slice(2);
if (paths.length === 0) {
    console.error('usage: validate_glb.mjs FILE...');
    process.exit(2);
}
let bad = 0;
for (const path of paths) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {uri: path, maxIssues: 20});
    const {numErrors, numWarnings, messages} = report.issues;
    console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, ${report.info.totalTriangleCount} triangles`);
    for (const issue of messages) {
        if (issue.severity <= 1) // 0 error, 1 warning
            console.log(`  ${issue.code} ${issue.pointer ?? ''}: ${issue.message}`);
    }
    bad += numErrors + numWarnings;
}
process.exit(bad ? 1 : 0);
