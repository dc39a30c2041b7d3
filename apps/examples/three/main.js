// Brushed metal under an environment in three.js, with and without a technique of burnish. ?model=FILE.glb opens another model, ?sky=FILE.hdr
// another environment; ?webgpu draws by WebGPU; ?alone begins with the engine alone.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { height, studio, width } from './studio.js';

const asked = new URLSearchParams(location.search), gpu = asked.has('webgpu'), state = document.getElementById('state'), improved = document.getElementById('improved');
improved.checked = !asked.has('alone');
const api = gpu ? await import('three/webgpu') : THREE; // its renderer
let renderer, improveAnisotropy, said = '';

function studio_texture() {
  const picture = new THREE.DataTexture(studio(), width, height, THREE.RGBAFormat, THREE.FloatType);
  picture.magFilter = picture.minFilter = THREE.LinearFilter;
  picture.needsUpdate = true;
  return picture;
}

// Returns the prefiltered environment that three.js makes.
async function environment() {
  const picture = asked.has('sky') ? await new HDRLoader().setDataType(THREE.FloatType).loadAsync(asked.get('sky')) : studio_texture();
  picture.mapping = THREE.EquirectangularReflectionMapping;
  return new api.PMREMGenerator(renderer).fromEquirectangular(picture).texture;
}

// Returns three brushed balls: highlights run around the first one, from pole to pole on the second one, and aslant on the third one.
function brushed_balls() {
  const balls = new THREE.Group();
  for (let i = 0; i < 3; ++i) {
    const shape = new THREE.SphereGeometry(1, 96, 64);
    shape.computeTangents();
    const metal = new THREE.MeshPhysicalMaterial({ color: [0xe8e4dc, 0xe6a35c, 0xd8b060][i], metalness: 1, roughness: 0.3, anisotropy: 0.8 });
    metal.anisotropyRotation = [0, Math.PI / 2, Math.PI / 4][i];
    const ball = new THREE.Mesh(shape, metal);
    ball.position.x = 2.3 * (i - 1);
    balls.add(ball);
  }
  return balls;
}

async function model() {
  return asked.has('model') ? (await new GLTFLoader().loadAsync(asked.get('model'))).scene : brushed_balls();
}

const told = count => `${count} material${count === 1 ? '' : 's'} improved`;

// Adds a model to a scene of its own.
async function scene_of(light, improve) {
  const scene = new THREE.Scene(), thing = await model();
  scene.environment = light;
  scene.background = new THREE.Color(0x000000);
  scene.add(thing);
  // Meshes from code have texture coordinates that grow upwards
  if (improve)
    said = told(improveAnisotropy(thing, gpu ? { environment: light } : { glTF: asked.has('model') }));
  return scene;
}

try {
  ({ improveAnisotropy } = await (gpu ? import('./burnish_three_node.js') : import('./burnish_three.js'))); // written by `npm start`
  renderer = gpu ? new api.WebGPURenderer({ antialias: true }) : new api.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  await renderer.init?.();
  if (gpu && !renderer.backend.isWebGPUBackend)
    throw new Error('this browser has no WebGPU');
  document.body.append(renderer.domElement);
  const light = await environment(), scenes = [await scene_of(light, false), await scene_of(light, true)];
  // Look at the model from a little above
  const box = new THREE.Box3().setFromObject(scenes[0]), sphere = box.getBoundingSphere(new THREE.Sphere()), { y, z } = box.getSize(new THREE.Vector3());
  const far = Math.max(sphere.radius * 2.2, 2 * y + z / 2); // high models fit too
  const camera = new THREE.PerspectiveCamera(30, 1, sphere.radius / 100, sphere.radius * 100);
  camera.position.copy(sphere.center).add(new THREE.Vector3(0, 0.25, 1).normalize().multiplyScalar(far));
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.copy(sphere.center);
  controls.update();
  const draw = () => {
    renderer.render(scenes[improved.checked ? 1 : 0], camera);
    state.textContent = improved.checked ? said : '';
  };
  const fit = () => {
    const { clientWidth: width, clientHeight: height } = document.documentElement;
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    draw();
  };
  controls.addEventListener('change', draw);
  improved.addEventListener('change', draw);
  addEventListener('resize', fit);
  fit();
  document.documentElement.dataset.drawn = 'yes'; // for programs that drive this page
} catch (error) {
  state.textContent = String(error);
  throw error;
}
