// tinyusdz on the USDA: usda_test.mjs FOLDER FOLDER-OF-NPM-PACKAGES. It parses the whole file, and knows the
// mesh at its first sample alone: faces and points are compared there. It is built for browsers.
import assert from 'node:assert';
import fs from 'node:fs';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [folder, packages] = process.argv.slice(2);
const module = path.resolve(packages, 'node_modules', 'tinyusdz');
process.type = 'renderer';
globalThis.window = globalThis;
const {default: start} = await import(pathToFileURL(path.join(module, 'tinyusdz.js')).href);
const wasm = fs.readFileSync(path.join(module, 'tinyusdz.wasm'));
const tinyusdz = await start({
  instantiateWasm: (imports, done) => {
    WebAssembly.instantiate(wasm, imports).then(({instance, module}) => done(instance, module));
    return {};
  },
});
const loader = new tinyusdz.TinyUSDZLoaderNative();
const usda = new Uint8Array(fs.readFileSync(folder + '/usda/cleave.usda'));
assert(loader.loadFromBinary(usda, 'cleave.usda'), loader.error());
assert.strictEqual(loader.numMeshes(), 1);
const mesh = loader.getMesh(0);
assert.strictEqual(mesh.absPath, '/cleave/Surface');

const cache = fs.readFileSync(folder + '/bake-pc2/cleave.pc2');
const count = cache.readInt32LE(16);
assert.strictEqual(mesh.points.length, 3 * count);
mesh.points.forEach((value, i) => assert.strictEqual(value, cache.readFloatLE(32 + 4 * i)));
// The OBJ lists faces by piece; as sets of corners they are the same.
const faces = [];
for (const line of fs.readFileSync(folder + '/bake-pc2/cleave.obj', 'ascii').split('\n')) {
  if (line.startsWith('f ')) faces.push(line.slice(2).split(' ').map((text) => parseInt(text) - 1).join());
}
const found = [];
for (let i = 0; i < mesh.faceVertexIndices.length; i += 3) {
  found.push(mesh.faceVertexIndices.slice(i, i + 3).join());
}
assert(mesh.faceVertexCounts.every((corners) => corners === 3));
assert.deepStrictEqual(found.sort(), faces.sort());
console.log(`tinyusdz: ${count} points and ${found.length} faces as in OBJ and PC2`);
