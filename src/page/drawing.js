// Draws a model with WebGL 2. Fronts only: the backs of walls are left out, so that one looks into rooms.
{
  const VERTEX = `#version 300 es
    uniform mat4 clip;
    uniform vec3 low, size;
    layout(location = 0) in vec3 place;
    layout(location = 1) in vec3 radiosity;
    layout(location = 2) in vec2 leaf;
    layout(location = 3) in float error;
    layout(location = 4) in vec2 uv;
    out vec3 light;
    out vec2 at;
    out vec3 corner;
    out float deviation;
    flat out vec2 kind;
    void main() {
      light = radiosity;
      at = uv;
      kind = leaf;
      deviation = error;
      int number = gl_VertexID % 3;
      corner = vec3(number == 0, number == 1, number == 2);
      gl_Position = clip * vec4(low + size * place, 1.0);
    }`;

  // Modes: 0 light, 1 radiosity, 2 level, 3 reason, 4 error. The tone curve is that of the pictures,
  // src/tone.rs, where it is explained. Light that falls on a picture is tone-mapped as the picture's brightest channel
  // would send it, `paint`, and the picture keeps its ratio to that; without the picture, `paint` is its mean colour.
  const FRAGMENT = `#version 300 es
    precision highp float;
    uniform int mode;
    uniform float exposure;
    uniform vec2 ends;
    uniform float mesh;
    uniform float pixel;
    uniform sampler2D palette;
    uniform sampler2D picture;
    uniform bool pictured;
    uniform vec3 paint;
    uniform float cutoff;
    in vec3 light;
    in vec2 at;
    in vec3 corner;
    in float deviation;
    flat in vec2 kind;
    out vec4 colour;

    float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

    vec3 toneMapped(vec3 lit) {
      float peak = max(lit.r, max(lit.g, lit.b));
      if (peak <= 0.4) return lit;
      float mapped = 1.0 - 0.36 / (peak + 0.2);
      float white = 1.0 - 1.0 / (0.15 * (peak - mapped) + 1.0);
      return mix(lit * (mapped / peak), vec3(mapped), white);
    }

    vec3 coded(vec3 linear) {
      vec3 c = clamp(linear, 0.0, 1.0);
      return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
    }

    vec3 along(float place) {
      return texture(palette, vec2((clamp(place, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
    }

    vec3 shown(vec3 texel) {
      vec3 sent = light * paint;
      if (mode == 0) return coded(toneMapped(sent * exposure) * texel);
      if (mode == 1) {
        float value = max(luminance(sent * texel), ends.x);
        return along(log(value / ends.x) / log(ends.y / ends.x));
      }
      if (mode == 4) return along((deviation - ends.x) / (ends.y - ends.x));
      float number = mode == 2 ? kind.x : kind.y;
      return texelFetch(palette, ivec2(int(number + 0.5), 0), 0).rgb;
    }

    // How much of the pixel a line covers. Distances to the edges are in pixels, so that lines are as
    // wide near as far; the lines of triangles a few pixels high fade, or fine meshes would turn black.
    float line() {
      vec3 slope = max(vec3(length(vec2(dFdx(corner.x), dFdy(corner.x))),
                            length(vec2(dFdx(corner.y), dFdy(corner.y))),
                            length(vec2(dFdx(corner.z), dFdy(corner.z)))), 1e-6);
      vec3 distances = corner / slope;
      float nearest = min(distances.x, min(distances.y, distances.z)) / pixel;
      float height = 1.0 / max(slope.x, max(slope.y, slope.z)) / pixel;
      return clamp(1.0 - nearest, 0.0, 1.0) * min(height / 6.0, 1.0);
    }

    void main() {
      vec4 texel = texture(picture, at);
      if (texel.a < cutoff) discard;
      vec3 c = shown(pictured ? texel.rgb : vec3(1.0));
      // Dark lines on bright surfaces, bright ones on dark, as in the pictures.
      vec3 ink = vec3(luminance(pow(c, vec3(2.2))) > 0.1 ? 0.0 : 1.0);
      colour = vec4(mix(c, ink, 0.6 * mesh * line()), 1.0);
    }`;

  const MODES = { light: 0, radiosity: 1, level: 2, reason: 3, error: 4 };
  const BACKGROUND = 0.07;

  function compiled(gl, kind, source) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    return shader;
  }

  function linked(gl) {
    const program = gl.createProgram();
    gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, VERTEX));
    gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(program);
    // A lost context links nothing and is no mistake in the program.
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getProgramInfoLog(program));
    }
    return program;
  }

  function makePalette(gl) {
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  }

  // What lies on a surface; read as linear light, as our own pictures read it.
  function makePicture(gl, { image, wrap, nearest }) {
    const wraps = { repeat: gl.REPEAT, mirror: gl.MIRRORED_REPEAT, clamp: gl.CLAMP_TO_EDGE };
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, image);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, nearest ? gl.NEAREST : gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, nearest ? gl.NEAREST_MIPMAP_LINEAR : gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wraps[wrap[0]]);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wraps[wrap[1]]);
    return made;
  }

  class Drawing {
    // Throws where there is no WebGL 2.
    constructor(canvas) {
      // The picture is kept for printing and for saving it.
      const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
      if (!gl) throw new Error("there is no WebGL 2");
      this.canvas = canvas;
      this.gl = gl;
      this.program = linked(gl);
      this.places = new Map();
      this.buffers = [0, 1, 2, 3, 4].map(() => gl.createBuffer());
      this.runs = [];
      this.pictures = new Map();
      gl.useProgram(this.program);
      makePalette(gl);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.CULL_FACE);
      gl.clearColor(BACKGROUND, BACKGROUND, BACKGROUND, 1);
    }

    setModel(model) {
      const { gl } = this;
      const attributes = [
        [model.positions, 3, gl.UNSIGNED_SHORT, true],
        [model.radiosity, 3, gl.FLOAT, false],
        [model.leaves, 2, gl.UNSIGNED_BYTE, false],
        [Float32Array.from(model.errors, (error) => error * model.errorStep), 1, gl.FLOAT, false],
        [model.uvs, 2, gl.FLOAT, false],
      ];
      attributes.forEach(([values, width, type, normalised], location) => {
        gl.disableVertexAttribArray(location);
        if (!values) return;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[location]);
        gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(location);
        gl.vertexAttribPointer(location, width, type, normalised, 0, 0);
      });
      gl.uniform3fv(this.uniform("low"), model.low);
      gl.uniform3fv(this.uniform("size"), model.size);
      this.runs = model.runs;
    }

    // 256 sRGB colours, as 768 bytes.
    setPalette(colours) {
      const { gl } = this;
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
    }

    // `pixel` is how many pixels of the canvas one of the page is wide.
    // `pictures` are those on surfaces, each `{image, wrap, nearest, white, mean}`; without `textures`, surfaces have
    // their mean colours, and their holes.
    draw({ clip, mode, exposure, ends, mesh, textures, pictures, pixel }) {
      const { gl } = this;
      gl.viewport(0, 0, this.canvas.width, this.canvas.height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.uniformMatrix4fv(this.uniform("clip"), false, clip);
      gl.uniform1i(this.uniform("mode"), MODES[mode]);
      gl.uniform1f(this.uniform("exposure"), exposure);
      gl.uniform2fv(this.uniform("ends"), ends);
      gl.uniform1f(this.uniform("mesh"), mesh ? 1 : 0);
      gl.uniform1f(this.uniform("pixel"), pixel);
      let first = 0;
      for (const { corners, picture, cutoff } of this.runs) {
        this.lay(pictures[picture], cutoff, textures);
        gl.drawArrays(gl.TRIANGLES, first, corners);
        first += corners;
      }
    }

    // What the next triangles show: a picture, its mean colour, or no more than their light. The palette takes the place
    // of a picture that is not there, since something must, and is not looked at.
    lay(picture, cutoff, textures) {
      const { gl } = this;
      const made = picture && this.made(picture);
      if (made) {
        gl.activeTexture(gl.TEXTURE1);
        gl.bindTexture(gl.TEXTURE_2D, made);
        gl.activeTexture(gl.TEXTURE0);
      }
      const { white, mean } = picture ?? { white: 1, mean: [1, 1, 1] };
      const isShown = Boolean(made && textures);
      gl.uniform1i(this.uniform("picture"), made ? 1 : 0);
      gl.uniform1i(this.uniform("pictured"), isShown ? 1 : 0);
      gl.uniform3fv(this.uniform("paint"), isShown ? [white, white, white] : mean);
      gl.uniform1f(this.uniform("cutoff"), (made && cutoff) ?? -1);
    }

    // The texture of a picture, once the browser has read it.
    made(picture) {
      const { complete, naturalWidth } = picture.image;
      if (!this.pictures.has(picture) && complete && naturalWidth > 0) {
        this.gl.activeTexture(this.gl.TEXTURE1);
        this.pictures.set(picture, makePicture(this.gl, picture));
        this.gl.activeTexture(this.gl.TEXTURE0);
      }
      return this.pictures.get(picture);
    }

    uniform(name) {
      if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
      return this.places.get(name);
    }
  }

  radiosity.Drawing = Drawing;
}
