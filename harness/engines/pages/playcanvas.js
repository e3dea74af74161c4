// PlayCanvas: a light component, whose map covers what the camera sees: the engine fits it itself.
import * as pc from "playcanvas";

const kTypes = {
  pcf1: pc.SHADOW_PCF1_32F,
  pcf3: pc.SHADOW_PCF3_32F,
  pcf5: pc.SHADOW_PCF5_32F,
  vsm16: pc.SHADOW_VSM_16F,
  vsm32: pc.SHADOW_VSM_32F,
  pcss: pc.SHADOW_PCSS_32F,
};
const kDepth = {
  uniqueName: "depth",
  attributes: { vertex_position: pc.SEMANTIC_POSITION },
  // One uniform a line: the engine finds those that it has in a block of its own, and takes their lines out.
  vertexGLSL: `attribute vec3 vertex_position;
    uniform mat4 matrix_model;
    uniform mat4 matrix_view;
    uniform mat4 matrix_viewProjection;
    varying float depth;
    void main() {
      vec4 world = matrix_model * vec4(vertex_position, 1.0);
      depth = -(matrix_view * world).z;
      gl_Position = matrix_viewProjection * world;
    }`,
  fragmentGLSL: "varying float depth; void main() { gl_FragColor = vec4(depth); }",
};

// The glTF materials shine; these are matt. `diffuse` is in sRGB, and the engine takes it to linear itself.
const toMatt = ({ diffuse, diffuseMap, alphaTest }, side) => {
  const material = new pc.StandardMaterial();
  const cull = side === "both" ? pc.CULLFACE_NONE : pc.CULLFACE_BACK;
  Object.assign(material, { diffuse, diffuseMap, alphaTest, cull, useMetalness: false, useSkybox: false });
  material.specular = new pc.Color(0, 0, 0);
  material.update();
  return material;
};

const loadModel = (app) =>
  new Promise((done, fail) => {
    const asset = new pc.Asset("scene", "container", { url: "/scene.glb" });
    asset.once("load", () => done(asset.resource.instantiateRenderEntity()));
    asset.once("error", (message) => fail(new Error(message)));
    app.assets.add(asset);
    app.assets.load(asset);
  });

const makeLight = (view, { type, bias, normal, distance, penumbra }) => {
  const entity = new pc.Entity("sun");
  entity.addComponent("light", { type: "directional", castShadows: true, shadowType: kTypes[type], shadowBias: bias });
  const shadows = { shadowResolution: view.maps[0].size, shadowDistance: distance, normalOffsetBias: normal };
  Object.assign(entity.light, shadows, { penumbraSize: penumbra });
  const down = new pc.Vec3(0, -1, 0); // a light shines along the -y axis of its entity
  entity.setRotation(new pc.Quat().setFromDirections(down, new pc.Vec3(view.light.direction)));
  return entity;
};

export const open = async ({ view, canvas, settings }) => {
  const app = new pc.Application(canvas, { graphicsDeviceOptions: { antialias: false } });
  app.autoRender = false;
  app.start();
  app.scene.ambientLight = new pc.Color(0, 0, 0);
  const model = await loadModel(app);
  model.findComponents("light").forEach((light) => (light.enabled = false));
  const parts = model.findComponents("render").flatMap((render) => render.meshInstances);
  const matts = parts.map((part) => toMatt(part.material, settings.side));
  const sun = makeLight(view, settings);
  [model, sun].forEach((entity) => app.root.addChild(entity));
  const { width, height } = view;
  const colorBuffer = new pc.Texture(app.graphicsDevice, {
    width,
    height,
    format: pc.PIXELFORMAT_RGBA32F,
    mipmaps: false,
  });
  const camera = model.findComponent("camera");
  Object.assign(camera, { enabled: true, clearColor: new pc.Color(0, 0, 0, 0), toneMapping: pc.TONEMAP_NONE });
  Object.assign(camera, { gammaCorrection: pc.GAMMA_NONE }); // linear
  camera.renderTarget = new pc.RenderTarget({ colorBuffer, depth: true });
  const depth = new pc.ShaderMaterial(kDepth);
  depth.cull = pc.CULLFACE_NONE;
  const draw = async (what) => {
    sun.light.castShadows = what === "lit";
    parts.forEach((part, i) => (part.material = what === "depth" ? depth : matts[i]));
    app.renderNextFrame = true;
    await new Promise((done) => app.once("frameend", done));
    return colorBuffer.read(0, 0, width, height);
  };
  const { bias, distance, normal, side, type } = settings;
  const map = `${view.maps[0].size}, ${type}`;
  const fit = `its own: a sphere around what the camera sees, up to ${distance} m`;
  return { draw, says: { map, bias: `${bias}, normal ${normal} m, casts ${side}`, fit } };
};
