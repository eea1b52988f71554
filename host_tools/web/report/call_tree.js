// SPDX-License-Identifier: MIT
// The profile in the page enters; call paths as a tree leave, laid out for a flame graph.

/** How a name looks in the data: the first few are waits. */
export function isWait(profile, name) {
  return name < profile.waits;
}

/** Paths with children; each: {index, name, parent, children, calls, self, total, depth, begin [cycles]}. The first is all. */
export function treeOf(profile) {
  const { parents, names, calls, selves, totals } = profile.paths;
  const paths = parents.map((parent, i) => ({ index: i, name: names[i], parent: null, children: [], calls: calls[i], self: selves[i], total: totals[i], depth: 0, begin: 0 }));
  // A path stands behind its parent and behind what is left of it.
  const used = paths.map(() => 0);
  paths.forEach((path, i) => {
    if (i === 0) return;
    const parent = paths[parents[i]];
    path.parent = parent;
    path.depth = parent.depth + 1;
    path.begin = parent.begin + used[parent.index];
    used[parent.index] += path.total;
    parent.children.push(path);
  });
  return paths;
}

/** From the first called on. */
export function ancestors(path) {
  const list = [];
  for (let at = path.parent; at !== null; at = at.parent) list.unshift(at);
  return list;
}

function inside(path, root) {
  let at = path;
  while (at !== null && at.depth > root.depth) at = at.parent;
  return at === root;
}

/**
 * What is seen where `root` takes the whole width [pixels]: [{path, x, width, row}], what is above it too, in full
 * width. Frames under `least` pixels are left out.
 */
export function layOut(paths, root, width, least) {
  const scale = root.total > 0 ? width / root.total : 0;
  const above = ancestors(root).map((path) => ({ path, x: 0, width, row: path.depth, above: true }));
  const below = paths.filter((path) => path.total * scale >= least && inside(path, root));
  return above.concat(below.map((path) => ({ path, x: (path.begin - root.begin) * scale, width: path.total * scale, row: path.depth, above: false })));
}

/** Where a key leads from a path; null: nowhere. */
export function neighbour(path, key) {
  const siblings = path.parent?.children ?? [path];
  const place = siblings.indexOf(path);
  const to = { ArrowUp: path.parent, ArrowDown: path.children[0], ArrowLeft: siblings[place - 1], ArrowRight: siblings[place + 1] }[key];
  return to ?? null;
}

/** Cycles on paths with a frame whose name has `text` in it, each counted once. */
export function cyclesOf(paths, matches) {
  let cycles = 0;
  const inMatch = [];
  paths.forEach((path) => {
    const above = path.parent !== null && inMatch[path.parent.index];
    const here = path.parent !== null && matches(path);
    inMatch[path.index] = above || here;
    if (here && !above) cycles += path.total;
  });
  return cycles;
}
