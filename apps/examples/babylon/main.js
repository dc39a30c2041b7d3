// Brushed metal under an environment in Babylon.js, with and without a technique of burnish. ?sky=FILE.hdr gives the environment, ?model=FILE.glb
// opens another model, ?alone begins with the engine alone.
import { studio_file } from './studio.js';

const asked = new URLSearchParams(location.search), state = document.getElementById('state'), improved = document.getElementById('improved');
improved.checked = !asked.has('alone');
const sky = asked.get('sky') ?? URL.createObjectURL(studio_file());
let engine, improveAnisotropy, said = '';
const told = count => `${count} material${count === 1 ? '' : 's'} improved`;

// Adds three brushed balls: highlights run around the first one, from pole to pole on the second one, and aslant on the third one.
function add_brushed_balls(scene) {
  const materials = [];
  for (let i = 0; i < 3; ++i) {
    const ball = BABYLON.MeshBuilder.CreateSphere('ball', { diameter: 2, segments: 48 }, scene), metal = new BABYLON.PBRMaterial('brushed', scene);
    ball.position.x = 2.3 * (i - 1);
    metal.albedoColor = BABYLON.Color3.FromHexString(['#e8e4dc', '#e6a35c', '#d8b060'][i]).toLinearSpace();
    metal.metallic = 1;
    metal.roughness = 0.3;
    metal.anisotropy.isEnabled = true;
    metal.anisotropy.intensity = 0.8;
    metal.anisotropy.direction = new BABYLON.Vector2(...[[1, 0], [0, 1], [Math.SQRT1_2, -Math.SQRT1_2]][i]);
    ball.material = metal;
    materials.push(metal);
  }
  return materials;
}

async function add_model(scene) {
  if (!asked.has('model'))
    return add_brushed_balls(scene);
  const loaded = await BABYLON.LoadAssetContainerAsync(asked.get('model'), scene);
  loaded.addAllToScene();
  return loaded.materials;
}

async function scene_of(improve) {
  const scene = new BABYLON.Scene(engine);
  scene.useRightHandedSystem = true;
  scene.clearColor = new BABYLON.Color4(0, 0, 0, 1);
  scene.environmentTexture = new BABYLON.HDRCubeTexture(sky, scene, 256, false, true, false, true);
  scene.environmentTexture.rotationY = Math.PI / 2;
  const materials = await add_model(scene);
  const { min, max } = scene.getWorldExtends(), middle = min.add(max).scale(0.5), size = max.subtract(min), radius = size.length() / 2;
  const camera = new BABYLON.ArcRotateCamera('camera', Math.PI / 2, 1.33, Math.max(radius * 2.2, 2 * size.y + size.z / 2), middle, scene);
  camera.fov = Math.PI / 6;
  camera.minZ = radius / 100;
  camera.maxZ = radius * 100;
  camera.lowerRadiusLimit = radius / 50;
  camera.wheelDeltaPercentage = 0.02;
  camera.panningSensibility = 1000 / radius;
  if (improve) // meshes from code have texture coordinates that grow upwards
    said = told(improveAnisotropy(BABYLON, materials, { glTF: asked.has('model') }));
  return scene;
}

try {
  ({ improveAnisotropy } = await import('./burnish_babylon.js')); // written by `npm start`
  engine = new BABYLON.Engine(document.getElementById('canvas'), true, { preserveDrawingBuffer: true }, true);
  const scenes = [await scene_of(false), await scene_of(true)];
  await Promise.all(scenes.map(scene => scene.whenReadyAsync()));
  // Both scenes look from one place
  const chosen = () => scenes[improved.checked ? 1 : 0];
  const tell = () => { state.textContent = improved.checked ? said : ''; };
  tell();
  improved.addEventListener('change', () => {
    tell();
    const [from, to] = improved.checked ? scenes : [scenes[1], scenes[0]];
    from.activeCamera.detachControl();
    for (const part of ['alpha', 'beta', 'radius'])
      to.activeCamera[part] = from.activeCamera[part];
    to.activeCamera.target = from.activeCamera.target.clone();
    to.activeCamera.attachControl();
  });
  chosen().activeCamera.attachControl();
  addEventListener('resize', () => engine.resize());
  engine.resize();
  engine.runRenderLoop(() => {
    chosen().render();
    document.documentElement.dataset.drawn = 'yes'; // for programs that drive this page
  });
} catch (error) {
  state.textContent = String(error);
  throw error;
}
