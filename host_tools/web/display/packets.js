// SPDX-License-Identifier: MIT
// The bytes of a `packets` message enter; packets, and how to draw them on the map of the torus, leave.

const kWaits = 4;
const kLeaves = 5;
const kRecordSize = 16;
const kColours = 12;

/** Contents of a `packets` message (docs/display.md). */
export function readPackets(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const count = view.getUint32(16, true);
  const list = [];
  for (let i = 0, at = 24; i < count; ++i, at += kRecordSize) {
    list.push({
      number: view.getUint32(at, true), source: view.getUint16(at + 4, true), destination: view.getUint16(at + 6, true),
      router: view.getUint16(at + 8, true), records: view.getUint16(at + 10, true),
      way: view.getUint8(at + 12), part: view.getUint8(at + 13) / 255,
    });
  }
  return { now: Number(view.getBigUint64(0, true)), speed: view.getFloat64(8, true), list, leftOut: view.getUint32(20, true) };
}

const kAhead = [[1, 0], [-1, 0], [0, 1], [0, -1]]; // east, west, south, north
const kBeside = [[0, 0.09], [0, -0.09], [-0.09, 0], [0.09, 0]]; // as the map draws the links

/** Where a packet is drawn, in distances between PEs from its router; those that wait stand side by side. */
function offset(packet, rank) {
  if (packet.way < kWaits) {
    const [x, y] = kAhead[packet.way];
    const [dx, dy] = kBeside[packet.way];
    return [x * packet.part + dx, y * packet.part + dy];
  }
  if (packet.way === kLeaves) return [0, 0.2 * (1 - packet.part)];
  return [-0.22 + 0.11 * (rank % 5), 0.36 - 0.1 * Math.floor(rank / 5)];
}

/** For TorusMap: each packet as a dot, of one colour all its way, as large as it has records. */
export function packetOverlay(packets) {
  if (!packets || packets.speed < 0 || packets.list.length === 0) return undefined;
  return (context, place, step) => {
    const waiting = new Map();
    for (const packet of packets.list) {
      const rank = packet.way === kWaits ? (waiting.get(packet.router) ?? 0) : 0;
      if (packet.way === kWaits) waiting.set(packet.router, rank + 1);
      const [x, y] = place(packet.router);
      const [dx, dy] = offset(packet, rank);
      context.beginPath();
      context.arc(x + dx * step, y + dy * step, Math.max(2, step * (0.04 + 0.02 * Math.min(1, packet.records / 8))), 0, 2 * Math.PI);
      context.fillStyle = `hsl(${((packet.number >>> 16) % kColours) * (360 / kColours)} 90% 50%)`;
      context.fill();
      context.lineWidth = 1;
      context.strokeStyle = "#000";
      context.stroke();
    }
  };
}
