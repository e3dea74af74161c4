// Babylon.js: a DirectionalLight with a ShadowGenerator, whose projection is the window of our map.
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { Matrix, Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { ShadowGenerator } from "@babylonjs/core/Lights/Shadows/shadowGenerator.js";
import { ImportMeshAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import { RenderTargetTexture } from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";
import { StandardMaterial } from "@babylonjs/core/Materials/standardMaterial.js";
import { Scene } from "@babylonjs/core/scene.js";
import "@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js";
import "@babylonjs/core/Rendering/depthRendererSceneComponent.js";
import "@babylonjs/loaders/glTF/2.0/glTFLoader.js";

const kFloat = 1,
  kNearest = 1; // Constants.TEXTURETYPE_FLOAT, Texture.NEAREST_SAMPLINGMODE
const kFilters = {
  none: ShadowGenerator.FILTER_NONE,
  pcf: ShadowGenerator.FILTER_PCF,
  pcss: ShadowGenerator.FILTER_PCSS,
  poisson: ShadowGenerator.FILTER_POISSONSAMPLING,
  esm: ShadowGenerator.FILTER_EXPONENTIALSHADOWMAP,
  blur_esm: ShadowGenerator.FILTER_BLUREXPONENTIALSHADOWMAP,
  close_esm: ShadowGenerator.FILTER_CLOSEEXPONENTIALSHADOWMAP,
  blur_close_esm: ShadowGenerator.FILTER_BLURCLOSEEXPONENTIALSHADOWMAP,
};
const kQualities = ["high", "medium", "low"]; // ShadowGenerator.QUALITY_HIGH is 0

// The glTF materials are PBRMaterial, which shines, and writes sRGB. A StandardMaterial's colours stay as they are.
const toMatt = (scene, { name, albedoColor, albedoTexture }, side) => {
  const material = new StandardMaterial(name, scene);
  Object.assign(material, { diffuseColor: albedoColor, diffuseTexture: albedoTexture, specularColor: Color3.Black() });
  material.backFaceCulling = side !== "both"; // which the shadow map obeys too
  return material;
};

// The generator takes the light's view to be left-handed, and culls accordingly: our window is right-handed, so that
// its u axis is mirrored, or the map would get the faces that look away from the light.
const projectToWindow = (light, { clip_from_world: clip }, isLeft) => {
  const mirror = Matrix.Scaling(-1, 1, 1);
  const window = Matrix.FromArray(clip).multiply(mirror);
  const ours = isLeft ? mirror.multiply(Matrix.FromArray(clip)) : window;
  light.customProjectionMatrixBuilder = (lightView, casters, projection) =>
    Matrix.Invert(lightView).multiplyToRef(ours, projection);
};

const makeShadows = (light, meshes, size, settings) => {
  const shadows = new ShadowGenerator(size, light, settings.store === "float");
  shadows.filter = kFilters[settings.type];
  shadows.filteringQuality = kQualities.indexOf(settings.quality);
  Object.assign(shadows, { bias: settings.bias, normalBias: settings.normal });
  shadows.contactHardeningLightSizeUVRatio = settings.light;
  shadows.forceBackFacesOnly = settings.side === "back";
  for (const mesh of meshes) {
    if (mesh.metadata?.gltf?.extras?.shadowbench?.casts_shadow !== false) shadows.addShadowCaster(mesh, false);
    mesh.receiveShadows = true;
  }
  return shadows;
};

export const open = async ({ view, canvas, settings }) => {
  const engine = new Engine(canvas, false);
  const scene = new Scene(engine);
  const isLeft = settings.hand === "left";
  scene.useRightHandedSystem = !isLeft; // left-handed, the loader mirrors x: of the model, not of scene.json's numbers
  const toScene = ([x, y, z]) => new Vector3(isLeft ? -x : x, y, z);
  await ImportMeshAsync("/scene.glb", scene, { pluginExtension: ".glb" });
  scene.lights.slice().forEach((light) => light.dispose());
  const meshes = scene.meshes.filter((mesh) => mesh.getTotalVertices() > 0);
  meshes.forEach((mesh) => (mesh.material = toMatt(scene, mesh.material, settings.side)));
  scene.activeCamera = scene.cameras[0];
  scene.clearColor = new Color4(0, 0, 0, 0);
  const [map] = view.maps,
    [layer] = map.layers;
  const light = new DirectionalLight("sun", toScene(view.light.direction), scene);
  light.position = toScene(layer.eye);
  if (settings.fit === "window") projectToWindow(light, layer, isLeft);
  makeShadows(light, meshes, map.size, settings);
  const target = new RenderTargetTexture("lit", view, scene, { type: kFloat, samplingMode: kNearest });
  Object.assign(target, { renderList: meshes, clearColor: scene.clearColor, activeCamera: scene.activeCamera });
  scene.customRenderTargets.push(target);
  const depth = scene.enableDepthRenderer(scene.activeCamera, false, true, kNearest, true).getDepthMap();
  const draw = async (what) => {
    light.shadowEnabled = what === "lit";
    await scene.whenReadyAsync(true);
    for (let frame = 0; frame < 2; ++frame) scene.render(); // a custom target is drawn before the frame's shadow maps
    if (what !== "depth") return target.readPixels();
    return (await depth.readPixels()).map(Math.abs); // right-handed, z is negative before the camera
  };
  const { bias, fit, normal, quality, side, store, type } = settings;
  const is = type === "pcf" || type === "pcss" ? "depth texture" : `${store === "float" ? "32" : "16"}-bit floats`;
  const says = { map: `${map.size}, ${is}`, bias: `${bias}, normal ${normal} m, casts ${side}` };
  if (type === "pcf" || type === "pcss") says.map += `, ${quality} quality`;
  return { draw, says: { ...says, fit: fit === "own" ? "its own, of the casters" : `window of ${map.fit}` } };
};
