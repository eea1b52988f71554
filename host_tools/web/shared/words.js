// SPDX-License-Identifier: MIT
// Names in the statistics enter, words for people who have not read the code leave.

export const kStages = {
  load: ["loading", "The host writes the scene and the firmware's tables into the PEs' memories, over the bus."],
  radiosity: ["radiosity", "Patches shoot light in rounds until little is unshot; each record of light travels from PE to PE until it meets a surface."],
  read: ["reading back", "The host reads the light that elements have received, and computes values at vertices."],
  load_again: ["loading again", "The host writes that light, and what the ray tracing stage needs, into the PEs' memories."],
  ray_tracing: ["ray tracing", "Camera rays are followed from PE to PE to what is seen; its light is added up in the frame buffer."],
  run: ["the run", "The PEs run the image until each has halted."],
};

const kPhases = {
  load: "taking in what is loaded",
  shoot: "making records of light",
  traverse: "following rays through subspaces",
  shade: "turning at surfaces, and shading",
  deposit: "adding light to elements",
  flush: "filling and sending packets",
  control: "messages with the host",
  dispatch: "choosing what to do next",
  program: "own program",
  outside: "outside of any phase",
};

/** Of an image of one's own, whose other names are the user's. */
const kOwnPhases = { program: kPhases.program, outside: kPhases.outside };

/** what: "render" or "run". */
export function phaseWords(what) {
  return what === "render" ? kPhases : kOwnPhases;
}

export const kWaits = {
  arrivals: "waiting for something to arrive",
  torus_place: "waiting for a place towards the torus",
  bus_place: "waiting for a place towards the bus",
  copy: "waiting for the NIU's copy",
  idle_at_end: "nothing more to do",
};

export const kRecordKinds = {
  light: "light of a shot",
  point: "points of shots, to the PEs that make their records",
  deposit: "flux for an element",
  ray: "rays",
  shadow_ray: "shadow rays",
  gather: "final gathering",
};

export const kBusKinds = {
  load: "loading",
  control: "control",
  broadcast: "broadcasts to all PEs",
  records: "records from the host",
  credits: "credits",
  answers: "answers to the host",
  text: "text",
  pixels: "pixels for the frame buffer",
  diverted: "diverted records",
};

export const kBusUsers = { host: "host", queues: "PEs", divert_buffers: "divert buffers" };

export const kHostWork = {
  message: "taking and sending messages",
  copy: "copying",
  entry: "entries in tables",
  compare: "comparing",
  camera_ray: "making camera rays",
  subspace: "stepping through subspaces",
  layout: "laying out memories",
  unpack: "unpacking what was read",
  lattice_triangle: "values at vertices",
  irradiance_fit: "fitting irradiance",
  filter_entry: "the pixel filter",
  hemicube_entry: "the hemi-cube",
};

export const kLinkDirections = ["east", "west", "south", "north"];

/** Falls back to the name itself, so that a new one still shows. */
export function word(names, name) {
  return names[name] ?? name.replaceAll("_", " ");
}

export function stageName(name) {
  return (kStages[name] ?? [word({}, name)])[0];
}
