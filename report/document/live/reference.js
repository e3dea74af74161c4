// A reference where no rays were traced: the mean visibility of many maps, each drawn from another point of the light.
const kReferenceMaps = 256;
const kGoldenAngle = Math.PI * (3 - Math.sqrt(5));
const kOtherAngle = 2 * Math.PI * (Math.SQRT2 - 1);
// Points of a ball whose first two coordinates are spread evenly over a disk, by the spiral of a sunflower. With the third
// they look so from every side: they are points of a sphere in four dimensions less one coordinate, and any two of its
// coordinates are spread evenly over a disk (Archimedes' theorem of the sphere and the cylinder, two dimensions up).
const ballPoint = (i, count) => {
  const [squared, angle] = [(i + 0.5) / count, i * kGoldenAngle];
  const radius = Math.sqrt(squared);
  return [radius * Math.cos(angle), radius * Math.sin(angle), Math.sqrt(1 - squared) * Math.cos(i * kOtherAngle)];
};

// `frame` is that of a lookup without a filter.
const makeReference = (gl, { player, picture, lightSize }, motion, visibility) => {
  const { width, height } = player.textureOf(visibility);
  const fragment = `#version 300 es
    precision highp float;
    uniform sampler2D mean;
    uniform sampler2D next;
    uniform float share;
    out float visibility;
    void main() {
      ivec2 pixel = ivec2(gl_FragCoord.xy);
      visibility = mix(texelFetch(mean, pixel, 0).x, texelFetch(next, pixel, 0).x, share);
    }`;
  const program = linkProgram(gl, "the reference", kTriangle, fragment);
  const array = gl.createVertexArray();
  const means = [0, 1].map(() => makeTarget(gl, gl.R32F, width, height));
  let maps = 0;
  const add = (texture) => {
    const [from, to] = [means[maps % 2], means[(maps + 1) % 2]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, to.framebuffer);
    gl.viewport(0, 0, width, height);
    [gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE, gl.SCISSOR_TEST].forEach((each) => gl.disable(each));
    gl.useProgram(program);
    [from.texture, texture].forEach((each, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, each);
      gl.bindSampler(unit, null);
      gl.uniform1i(gl.getUniformLocation(program, unit === 0 ? "mean" : "next"), unit);
    });
    gl.uniform1f(gl.getUniformLocation(program, "share"), 1 / ++maps);
    gl.bindVertexArray(array);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };
  return {
    // Begins anew, since light or camera have moved.
    restart: () => (maps = 0),
    count: () => maps,
    texture: () => means[maps % 2].texture,
    read: () => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, means[maps % 2].framebuffer);
      return readValues(gl, width, height);
    },
    // Adds some maps from points of a light that is turned so.
    refine: (light, count) => {
      for (const last = Math.min(maps + count, kReferenceMaps); maps < last;) {
        const point = ballPoint(maps, kReferenceMaps).map((value) => 0.5 * lightSize * value);
        motion.moveLight(light, point);
        player.draw(visibility);
        add(player.textureOf(visibility).object);
      }
      motion.moveLight(light);
      return maps < kReferenceMaps;
    },
  };
};
