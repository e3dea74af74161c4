// Filament: a directional light, whose map the engine fits to what the camera sees, drawn into a texture of floats.
import { fail, loadPackage, watch } from "./filament_package.js";

// Its materials shine, but for those with a specular colour, which can be black; others need its compiler, so that the
// one without a `side` has depth as a colour of its vertices, and no light.
const rewrite = ({ model, bytes }, { position, forward }, side, assets) => {
  const gltf = structuredClone(model);
  const addBuffer = (part) => {
    const uri = `${Object.keys(assets).length}.bin`;
    assets[`${location.origin}/${uri}`] = part; // where the engine looks before it fetches
    return { uri, byteLength: part.byteLength };
  };
  const extension = side ? "KHR_materials_pbrSpecularGlossiness" : "KHR_materials_unlit";
  gltf.extensionsUsed.push(extension);
  gltf.materials = gltf.materials.map(({ pbrMetallicRoughness: is, ...rest }) => {
    const color = { diffuseFactor: is.baseColorFactor, diffuseTexture: is.baseColorTexture };
    const matt = side ? { ...color, specularFactor: [0, 0, 0], glossinessFactor: 0 } : {};
    return { ...rest, doubleSided: side !== "front", extensions: { [extension]: matt } };
  });
  gltf.buffers = [addBuffer(bytes)];
  for (const { attributes } of side ? [] : gltf.meshes.flatMap((mesh) => mesh.primitives)) {
    const { bufferView, count } = gltf.accessors[attributes.POSITION];
    const start = bytes.byteOffset + (gltf.bufferViews[bufferView].byteOffset ?? 0);
    const points = new Float32Array(bytes.buffer, start, 3 * count);
    const depth = (i) => forward.reduce((sum, f, k) => sum + f * (points[3 * i + k] - position[k]), 0);
    const colors = Float32Array.from({ length: 4 * count }, (_, i) => (i % 4 < 3 ? depth(i >> 2) : 1));
    const buffer = gltf.buffers.push(addBuffer(new Uint8Array(colors.buffer))) - 1;
    const view = gltf.bufferViews.push({ buffer, byteLength: colors.byteLength }) - 1;
    attributes.COLOR_0 = gltf.accessors.push({ bufferView: view, componentType: 5126, count, type: "VEC4" }) - 1;
  }
  return new TextEncoder().encode(JSON.stringify(gltf));
};

const readModel = (file) => {
  const length = new DataView(file).getUint32(12, true);
  const model = JSON.parse(new TextDecoder().decode(new Uint8Array(file, 20, length)));
  return { model, bytes: new Uint8Array(file, 28 + length, model.buffers[0].byteLength) };
};

const makeSun = (F, engine, { light, maps }, { bias, normal, offset, slope, lispsm }) => {
  const sun = F.EntityManager.get().create();
  const biases = { constantBias: bias, normalBias: normal, polygonOffsetConstant: offset, polygonOffsetSlope: slope };
  const options = { mapSize: maps[0].size, ...biases, lispsm: lispsm === "on", shadowBulbRadius: 0.02 };
  const builder = F.LightManager.Builder(F.LightManager$Type.DIRECTIONAL).direction(light.direction);
  builder.color([1, 1, 1]).intensity(Math.PI).shadowOptions(options).build(engine, sun);
  return sun;
};

const makeTarget = (F, engine, { width, height }) => {
  const make = (format, usage) => {
    const builder = F.Texture.Builder().width(width).height(height).levels(1);
    return builder.format(F.Texture$InternalFormat[format]).usage(usage).build(engine);
  };
  const { COLOR, DEPTH } = F.RenderTarget$AttachmentPoint;
  const builder = F.RenderTarget.Builder().texture(COLOR, make("RGBA32F", 0x11)); // an attachment that can be read
  return builder.texture(DEPTH, make("DEPTH32F", 2)).build(engine);
};

export const open = async ({ view, canvas, settings }) => {
  const F = await loadPackage();
  const read = watch(canvas.getContext("webgl2", { antialias: false }), settings.precision);
  const engine = F.Engine.create(canvas);
  const [swapChain, renderer, loader] = [engine.createSwapChain(), engine.createRenderer(), engine.createAssetLoader()];
  const file = readModel(await (await fetch("/scene.glb")).arrayBuffer());
  const load = async (side) => {
    const asset = loader.createAsset(rewrite(file, view.camera, side, F.assets));
    await new Promise((done) => asset.loadResources(done));
    const scene = engine.createScene();
    scene.addEntities(asset.getRenderableEntities());
    return scene;
  };
  const scenes = { lit: await load(settings.side), depth: await load() };
  const [sun, lights] = [makeSun(F, engine, view, settings), engine.getLightManager()];
  scenes.lit.addEntity(sun);
  const camera = engine.createCamera(F.EntityManager.get().create());
  const { right, up, forward, position, vertical_fov_deg: fov } = view.camera;
  const { znear, zfar } = file.model.cameras[0].perspective ?? fail("the page draws cameras with a perspective");
  camera.setProjectionFov(fov, view.width / view.height, znear, zfar, F.Camera$Fov.VERTICAL);
  camera.setModelMatrix([...right, 0, ...up, 0, ...forward.map((x) => -x), 0, ...position, 1]);
  camera.setExposureDirect(1);
  const eye = engine.createView();
  eye.setCamera(camera);
  eye.setViewport([0, 0, view.width, view.height]);
  eye.setPostProcessingEnabled(false); // linear values
  eye.setRenderTarget(makeTarget(F, engine, view));
  renderer.setClearOptions({ clear: true });
  const draw = (what) => {
    eye.setScene(scenes[what] ?? scenes.lit);
    lights.setShadowCaster(lights.getInstance(sun), what === "lit");
    renderer.beginFrame(swapChain); // false where it would skip one for its pace
    renderer.renderView(eye);
    renderer.endFrame();
    engine.execute();
    return read();
  };
  const { bias, normal, offset, slope, side, lispsm } = settings;
  const biases = `${bias}, normal ${normal}, polygon offset ${offset} and ${slope}, casts ${side}`;
  const fit = `its own, ${lispsm === "on" ? "warped (LiSPSM)" : "not warped"}`;
  return { draw, says: { map: `${view.maps[0].size}, depth of 16 bits`, bias: biases, fit } };
};
