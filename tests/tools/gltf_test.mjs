// The Khronos validator and three.js on the GLB: gltf_test.mjs FOLDER FOLDER-OF-NPM-PACKAGES.
import assert from 'node:assert';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [folder, packages] = process.argv.slice(2);
const modules = path.join(packages, 'node_modules');
const validator = createRequire(path.resolve(modules, 'index.js'))('gltf-validator');
const load = (file) => import(pathToFileURL(path.resolve(modules, 'three', file)).href);
const THREE = await load('build/three.module.js');
const {GLTFLoader} = await load('examples/jsm/loaders/GLTFLoader.js');
globalThis.self ??= globalThis;  // which the loader expects of a browser

const glb = new Uint8Array(fs.readFileSync(folder + '/glb/cleave.glb'));
const report = await validator.validateBytes(glb);
assert.strictEqual(report.issues.numErrors, 0, JSON.stringify(report.issues.messages.slice(0, 5)));
assert.strictEqual(report.issues.numWarnings, 0, JSON.stringify(report.issues.messages.slice(0, 5)));

// The last frame of the point cache, by rest position: float triples as keys.
const cache = fs.readFileSync(folder + '/bake-pc2/cleave.pc2');
const count = cache.readInt32LE(16), frames = cache.readInt32LE(28);
const key = (x, y, z) => [x, y, z].map((v) => Math.fround(v) + 0).join(' ');
const copies = new Map();
let point = 0;
for (const line of fs.readFileSync(folder + '/bake-pc2/cleave.obj', 'ascii').split('\n')) {
  if (!line.startsWith('v ')) continue;
  const place = key(...line.slice(2).split(' ').map(Number));
  copies.set(place, [...copies.get(place) ?? [], point++]);
}
assert.strictEqual(point, count);

const gltf = await new GLTFLoader().parseAsync(glb.buffer, '');
const mixer = new THREE.AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations[0]).setLoop(THREE.LoopOnce).play();
mixer.clipAction(gltf.animations[0]).clampWhenFinished = true;
let worst = 0, vertices = 0, triangles = 0;
for (const frame of [0, 10, 20, 30, frames - 1]) {
  mixer.setTime(frame / 24);
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const {position, _rest: rest, _piece: piece} = mesh.geometry.attributes;
    assert(piece && rest);
    if (frame === 0) triangles += mesh.geometry.index.count / 3;
    for (let i = 0; i < position.count; ++i, ++vertices) {
      const shown = mesh.getVertexPosition(i, new THREE.Vector3()).applyMatrix4(mesh.matrixWorld);
      const scene = [shown.x, -shown.z, shown.y];  // y up to z up
      const distances = copies.get(key(rest.getX(i), rest.getY(i), rest.getZ(i))).map((copy) => {
        const at = 32 + 12 * (count * frame + copy);
        return Math.max(...scene.map((v, k) => Math.abs(v - cache.readFloatLE(at + 4 * k))));
      });
      worst = Math.max(worst, Math.min(...distances));
    }
  });
}
assert(worst < 2e-6, `${worst} m off`);
assert.strictEqual(triangles, report.info.totalTriangleCount);
console.log(`valid; three.js: ${vertices} vertices in 5 frames, at most ${worst} m off`);
