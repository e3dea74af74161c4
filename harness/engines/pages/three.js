// three.js: WebGLRenderer with a DirectionalLight, whose shadow camera is the window of our map.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const kTypes = { basic: THREE.BasicShadowMap, pcf: THREE.PCFShadowMap, vsm: THREE.VSMShadowMap };
const kSides = { back: THREE.BackSide, front: THREE.FrontSide, both: THREE.DoubleSide };
const kDepth = {
  vertexShader: `varying float depth;
    void main() { vec4 p = modelViewMatrix * vec4(position, 1.0); depth = -p.z; gl_Position = projectionMatrix * p; }`,
  fragmentShader: "varying float depth; void main() { gl_FragColor = vec4(depth); }",
  side: THREE.DoubleSide,
};

const toMatt = ({ color, map, alphaTest }, shadowSide) =>
  new THREE.MeshLambertMaterial({ color, map, alphaTest, side: THREE.DoubleSide, shadowSide });

const makeLight = ({ maps: [{ size, layers }] }, { bias, normal, radius }) => {
  const { eye, forward, up, left, right_side: right, top, bottom, near, far } = layers[0];
  const light = new THREE.DirectionalLight();
  light.position.set(...eye); // its direction is from here to the target: both at the origin is no direction
  light.target.position.set(...eye).add(new THREE.Vector3(...forward));
  light.shadow.camera.up.set(...up);
  Object.assign(light.shadow.camera, { left, right, top, bottom, near, far });
  Object.assign(light.shadow, { bias, normalBias: normal, radius });
  light.shadow.mapSize.set(size, size);
  return light;
};

export const open = async ({ view, canvas, settings }) => {
  const renderer = new THREE.WebGLRenderer({ canvas });
  Object.assign(renderer.shadowMap, { enabled: true, type: kTypes[settings.type] });
  const target = new THREE.WebGLRenderTarget(view.width, view.height, { type: THREE.FloatType });
  const model = await new GLTFLoader().loadAsync("/scene.glb");
  const scene = new THREE.Scene(); // model.scene is a Group, on which overrideMaterial does nothing
  const light = makeLight(view, settings);
  const lights = [];
  // Where a material says nothing, its back faces cast; but for VSM the faces that it shows (WebGLShadowMap.js).
  const side = settings.side !== "auto" ? settings.side : settings.type === "vsm" ? "front" : "back";
  model.scene.traverse((node) => {
    if (node.isLight) lights.push(node);
    if (!node.isMesh) return;
    node.material = toMatt(node.material, kSides[side]);
    node.castShadow = node.userData.shadowbench?.casts_shadow ?? true;
    node.receiveShadow = true;
  });
  lights.forEach((node) => node.removeFromParent());
  scene.add(model.scene, light, light.target);
  const depth = new THREE.ShaderMaterial(kDepth);
  const draw = (what) => {
    light.castShadow = what === "lit";
    scene.overrideMaterial = what === "depth" ? depth : null;
    renderer.setRenderTarget(target); // a target gets linear values; the canvas gets sRGB
    renderer.setClearColor(0, 0);
    renderer.render(scene, model.cameras[0]);
    const values = new Float32Array(4 * view.width * view.height);
    renderer.readRenderTargetPixels(target, 0, 0, view.width, view.height, values);
    return values;
  };
  const { bias, normal, radius, type } = settings;
  const map = `${view.maps[0].size}, ${type === "vsm" ? "half floats" : "depth texture"}`;
  const says = { map, bias: `${bias}, normal ${normal} m, casts ${side}`, fit: `window of ${view.maps[0].fit}` };
  if (type !== "basic") says.map += `, radius ${radius}`;
  return { draw, says };
};
