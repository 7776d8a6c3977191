// mcap_reader.mjs FILE: reads an MCAP file with the reader from npm, by its index and from front to back, checksums checked, and
// decodes its messages as Foxglove does. Prints a line of JSON; foreign_readers_test.py compares it with the log.
// The packages are those of scope/page (HYDRO_SCOPE_PAGE names another folder).
import { open } from 'node:fs/promises';
import { createReadStream } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const page = process.env.HYDRO_SCOPE_PAGE ?? path.join(here, '../../../scope/page');
const require = createRequire(path.join(page, 'package.json'));
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader } = require('@foxglove/rosmsg2-serialization');

const file = await open(process.argv[2]);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, size) => {
    const bytes = new Uint8Array(Number(size));
    const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
    if (bytesRead !== bytes.length) throw new Error(`wanted ${size} bytes at ${offset}, found ${bytesRead}`);
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
const found = { topics: {}, metadata: {}, attachments: {}, chunks: reader.chunkIndexes.length, streamed: 0 };
found.statistics = {
  messages: reader.statistics.messageCount,
  start: reader.statistics.messageStartTime,
  end: reader.statistics.messageEndTime,
};
const readers = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  const text = new TextDecoder().decode(schema.data);
  readers.set(channel.id, new MessageReader(parse(text, { ros2: true })));
  found.topics[channel.topic] = {
    type: schema.name,
    schema: text,
    encoding: channel.messageEncoding,
    metadata: Object.fromEntries(channel.metadata),
    count: reader.statistics.channelMessageCounts.get(channel.id),
    messages: [],
  };
}
for await (const message of reader.readMessages()) {
  const { topic } = reader.channelsById.get(message.channelId);
  const values = readers.get(message.channelId).readMessage(message.data);
  found.topics[topic].messages.push({ '@log': message.logTime, '@sent': message.publishTime, ...values });
}
for await (const record of reader.readMetadata()) found.metadata[record.name] = Object.fromEntries(record.metadata);
for await (const record of reader.readAttachments())
  found.attachments[record.name] = new TextDecoder().decode(record.data);

const stream = new McapStreamReader({ validateCrcs: true });
for await (const bytes of createReadStream(process.argv[2])) {
  stream.append(bytes);
  for (let record; (record = stream.nextRecord());) if (record.type === 'Message') ++found.streamed;
}
found.streamDone = stream.done();

// JSON has no 64-bit integers and no NaN.
const plain = (_, value) => {
  if (typeof value === 'bigint') return `${value}`;
  if (typeof value === 'number' && !Number.isFinite(value)) return `${value}`;
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
};
process.stdout.write(JSON.stringify(found, plain) + '\n');
await file.close();
