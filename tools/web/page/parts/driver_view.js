// The driver's view of the road ahead, with three.js. Fog reduces contrast by Koschmieder's law: at
// the distance d, the fraction exp(-sigma d) of the contrast is left. The page loads this file only
// when it shows the view.

import {
  AmbientLight, BoxGeometry, Color, CylinderGeometry, DirectionalLight, Fog, Group, InstancedMesh,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, PlaneGeometry, Scene,
  ShaderChunk, WebGLRenderer,
} from "three";

import {carsOf, extinction} from "../data/cars.js";

// Replaces the fog of three.js. That fog follows another law, and depends on the depth instead of
// the distance. `fogNear` contains sigma in 1/m. Each pixel computes its own distance, because the
// ground has few vertices. Light adds up linearly, so the colours are made linear before they are
// mixed.
const chunk = (lines) => `#ifdef USE_FOG\n${lines}\n#endif`;
ShaderChunk.fog_pars_vertex = chunk("varying vec3 vFogPlace;");
ShaderChunk.fog_vertex = chunk("vFogPlace = mvPosition.xyz;");
ShaderChunk.fog_pars_fragment = chunk(
  "uniform vec3 fogColor;\nuniform float fogNear;\nvarying vec3 vFogPlace;");
ShaderChunk.fog_fragment = chunk(`
  vec4 haze = sRGBTransferEOTF(vec4(fogColor, 1.0));
  vec4 thing = sRGBTransferEOTF(gl_FragColor);
  gl_FragColor = sRGBTransferOETF(mix(haze, thing, exp(-fogNear * length(vFogPlace))));`);

const EYE = {height_m: 1.25, behind_front_m: 2.1};
const LANE_M = 3.6;
const ROAD_M = 420;      // length of the road that is shown
const DASH = {length_m: 6, period_m: 18};
const POST_PERIOD_M = 50;
const FIELD_OF_VIEW = 24;  // vertical, in degrees
const MOST_RATIO = 2;    // pixels of the picture per pixel of the page
const COLOURS = {sky: "#cdd5db", asphalt: "#565b60", verge: "#8a937c", marking: "#f1f1ec", car: "#39485a"};

/** Whether the browser has no graphics processor. Smooth edges would then take too much time. */
function drawsInSoftware() {
  const probe = document.createElement("canvas").getContext("webgl2");
  const info = probe?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? probe.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

const lambert = (color) => new MeshLambertMaterial({color});
const basic = (color, more) => new MeshBasicMaterial({color, ...more});

function box(width, height, length, material, x, y, z) {
  const mesh = new Mesh(new BoxGeometry(width, height, length), material);
  mesh.position.set(x, y, z);
  return mesh;
}

/** A strip on the road, from behind the eye to the horizon. */
function strip(width, material, x, y = 0) {
  const mesh = new Mesh(new PlaneGeometry(width, ROAD_M + 40, 1, 60), material);
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.set(x, y, -ROAD_M / 2 + 20);
  return mesh;
}

/** A row of equal objects along the road. */
function row(geometry, material, period_m, places) {
  const n = Math.ceil(ROAD_M / period_m) + 1;
  const mesh = new InstancedMesh(geometry, material, n * places.length);
  const matrix = new Matrix4();
  places.forEach(([x, y], side) => {
    for (let i = 0; i < n; ++i) {
      matrix.makeTranslation(x, y, -i * period_m);
      mesh.setMatrixAt(side * n + i, matrix);
    }
  });
  mesh.frustumCulled = false;
  return mesh;
}

/** A car whose rear is at z = 0, seen from behind. */
function makeCar() {
  const car = new Group();
  const body = lambert(COLOURS.car);
  const dark = lambert("#14181c");
  car.add(box(1.82, 0.62, 4.5, body, 0, 0.62, -2.25));
  car.add(box(1.56, 0.52, 2.3, body, 0, 1.17, -2.1));
  car.add(box(1.4, 0.36, 0.04, dark, 0, 1.18, -0.93));
  car.add(box(1.7, 0.2, 0.06, dark, 0, 0.38, 0));
  car.add(box(0.52, 0.12, 0.02, lambert("#e8e8e2"), 0, 0.62, 0.02));
  for (const x of [-0.72, 0.72]) car.add(box(0.24, 0.62, 0.62, dark, x, 0.31, -0.85));
  const off = lambert("#5d1712");
  const on = basic("#ff2a1a");
  const lamps = [...[-0.68, 0.68].map((x) => box(0.36, 0.16, 0.04, off, x, 0.8, 0.01)),
                 box(0.4, 0.05, 0.04, off, 0, 1.4, -0.92)];
  car.add(...lamps);
  const glow = basic("#ff2a1a", {transparent: true, opacity: 0.28, depthWrite: false});
  const halos = [-0.68, 0.68].map((x) => box(0.62, 0.4, 0.02, glow, x, 0.8, 0.04));
  car.add(...halos);
  const brake = (shine) => {
    for (const lamp of lamps) lamp.material = shine ? on : off;
    for (const halo of halos) halo.visible = shine;
  };
  brake(false);
  return {car, brake};
}

export class DriverView {
  /** Throws if the browser has no WebGL. */
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer(
      {canvas, antialias: !drawsInSoftware(), powerPreference: "low-power"});
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 2, 0.2, ROAD_M);
    this.camera.position.set(0, EYE.height_m, 0);
    this.camera.rotation.x = -0.07;
    this.makeScene();
    this.warmUp();
  }

  /**
   * Draws everything once, and clears the picture. A browser compiles a shader when it first draws
   * with the shader, and does nothing else meanwhile. Without warmUp(), this would happen when the
   * car ahead brakes for the first time. The person's pedals would have no effect meanwhile.
   */
  warmUp() {
    this.lead.position.z = -20;  // in sight
    this.brake(true);
    this.renderer.render(this.scene, this.camera);
    this.brake(false);
    this.renderer.setClearAlpha(0);
    this.renderer.clear();
  }

  makeScene() {
    const scene = new Scene();
    scene.background = new Color(COLOURS.sky);
    scene.fog = new Fog(COLOURS.sky, 0, 1);
    scene.add(new AmbientLight("#ffffff", 2));
    const sun = new DirectionalLight("#ffffff", 1.2);
    sun.position.set(-3, 8, 6);
    scene.add(sun);
    scene.add(strip(600, basic(COLOURS.verge), 0, -0.02));
    scene.add(strip(2 * LANE_M + 2.6, basic(COLOURS.asphalt), -LANE_M / 2));
    const marking = basic(COLOURS.marking);
    scene.add(strip(0.16, marking, LANE_M / 2, 0.01), strip(0.16, marking, -1.5 * LANE_M, 0.01));
    const dash = new PlaneGeometry(0.16, DASH.length_m);
    dash.rotateX(-Math.PI / 2);
    this.dashes = row(dash, marking, DASH.period_m, [[-LANE_M / 2, 0.01]]);
    const posts = [[LANE_M / 2 + 2, 0.45], [-1.5 * LANE_M - 2, 0.45]];
    const post = new CylinderGeometry(0.07, 0.07, 0.9, 6);
    const band = new CylinderGeometry(0.075, 0.075, 0.2, 6);
    this.posts = row(post, lambert("#f0f0ea"), POST_PERIOD_M, posts);
    this.bands = row(band, lambert("#202428"), POST_PERIOD_M, posts.map(([x]) => [x, 0.72]));
    const {car, brake} = makeCar();
    this.lead = car;
    this.brake = brake;
    scene.add(this.dashes, this.posts, this.bands, car);
    this.scene = scene;
  }

  fit(share) {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (width === 0 || height === 0) return false;
    const ratio = share * Math.min(devicePixelRatio, MOST_RATIO);
    const size = `${width} ${height} ${ratio}`;
    if (size !== this.size) {
      this.size = size;
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    return true;
  }

  /**
   * @param moment {frame, ahead_s, length_m}
   * @param share resolution of the picture, as a share of the full resolution
   */
  draw({frame: {TRUTH: truth}, ahead_s, length_m}, share) {
    if (!truth || !this.fit(share)) return;
    const eye_m = truth.host_position_m + ahead_s * truth.host_speed_mps - EYE.behind_front_m;
    const phase = (period_m) => ((eye_m % period_m) + period_m) % period_m;
    this.dashes.position.z = phase(DASH.period_m) - DASH.length_m / 2;
    this.posts.position.z = this.bands.position.z = phase(POST_PERIOD_M);
    const [lead] = carsOf(truth, ahead_s);
    this.lead.position.z = -(lead.front_m - length_m + EYE.behind_front_m);
    this.brake(lead.brakes);
    this.scene.fog.near = extinction(truth.fog_visibility_m);
    this.renderer.render(this.scene, this.camera);
  }
}
