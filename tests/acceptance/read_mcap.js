// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// What @mcap/core finds in a file, as JSON: streamed from its beginning, and through its summary.
//   node read_mcap.mjs FILE, under that name: it is a module
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import fs from "node:fs";

const bytes = new Uint8Array(fs.readFileSync(process.argv[2]));
const found = { error: null, done: false, sequences: [], log_times_ns: [], values: [], indexed: {} };

function counts(data) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  // Two bytes a count, one of flags for every four counts.
  return Array.from({ length: (4 * data.byteLength) / 9 }, (_, i) => view.getInt16(2 * i, true));
}

try {
  const reader = new McapStreamReader();
  for (let at = 0; at < bytes.length && !reader.done(); at += 65536) {
    reader.append(bytes.subarray(at, at + 65536));
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type !== "Message") continue;
      found.sequences.push(record.sequence);
      found.log_times_ns.push(Number(record.logTime));
      found.values.push(counts(record.data));
    }
  }
  found.done = reader.done();
} catch (error) {
  found.error = String(error.message);
}

try {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  found.indexed = {
    messages: Number(reader.statistics?.messageCount),
    topics: [...reader.channelsById.values()].map((channel) => channel.topic),
    metadata: [],
  };
  for await (const metadata of reader.readMetadata()) found.indexed.metadata.push(metadata.name);
} catch (error) {
  found.indexed = { error: String(error.message) };
}

console.log(JSON.stringify(found));
