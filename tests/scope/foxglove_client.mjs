// foxglove_client.mjs PORT TOKEN SUBPROTOCOL: subscribes to a stack through hydro-scope with Foxglove's own client and decoders.
// Prints a line of JSON: the topics, and of each what was decoded; foxglove_test.py compares it with the log.
// The packages are those of scope/page (HYDRO_SCOPE_PAGE names another folder).
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const page = process.env.HYDRO_SCOPE_PAGE ?? path.join(here, '../../scope/page');
const require = createRequire(path.join(page, 'package.json'));
const { FoxgloveClient } = require('@foxglove/ws-protocol');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader } = require('@foxglove/rosmsg2-serialization');
const { WebSocket } = require('ws');

const [port, token, subprotocol] = process.argv.slice(2);
const kStates = 300;
const socket = new WebSocket(`ws://127.0.0.1:${port}/?token=${token}`, [subprotocol]);
const client = new FoxgloveClient({ ws: socket });
const found = { subprotocol: null, server: null, topics: {}, problems: [] };
const readers = new Map();

client.on('error', (error) => found.problems.push(String(error)));
client.on('status', (status) => found.problems.push(status.message));
client.on('serverInfo', (info) => {
  found.server = info.name;
  found.subprotocol = socket.protocol;
});
client.on('advertise', (channels) => {
  for (const channel of channels) {
    const definitions = parse(channel.schema, { ros2: true });
    found.topics[channel.topic] = { encoding: channel.encoding, schema: channel.schemaName, messages: [] };
    readers.set(client.subscribe(channel.id), { reader: new MessageReader(definitions), topic: channel.topic });
  }
});
let enough = false;
client.on('message', ({ subscriptionId, timestamp, data }) => {
  if (enough) return;
  const { reader, topic } = readers.get(subscriptionId);
  const { messages } = found.topics[topic];
  if (messages.length < kStates) messages.push({ utime: String(timestamp / 1000n), ...reader.readMessage(data) });
  if (
    found.topics['/hydro/state'].messages.length < kStates ||
    found.topics['/hydro/loop_statistics'].messages.length < 1
  )
    return;
  enough = true;
  client.close();
  const text = JSON.stringify(found, (_, value) => (typeof value === 'bigint' ? Number(value) : value));
  process.stdout.write(text + '\n', () => process.exit(0));
});
