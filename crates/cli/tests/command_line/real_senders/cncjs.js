// A client of CNCjs's server, for tests: each line of the input is a JSON array, an event and its
// arguments, and is emitted; each event that comes is a line of the output, in the same form.
//
//     node cncjs.js FOLDER_OF_SOCKET_IO_CLIENT URL

'use strict';

const { createInterface } = require('node:readline');

const [library, url] = process.argv.slice(2);
const say = (...event) => process.stdout.write(`${JSON.stringify(event)}\n`);

async function main() {
  // Without users, CNCjs gives everybody on this computer a token.
  const answer = await fetch(`${url}/api/signin`, { method: 'POST' });
  const { token } = await answer.json();
  const socket = require(library)(url, { query: `token=${token}`, reconnection: false });
  for (const event of ['connect', 'connect_error', 'error', 'disconnect']) {
    socket.on(event, (why) => say(event, String(why ?? '')));
  }
  const handle = socket.onevent;
  socket.onevent = (packet) => {
    // The text of a program comes back with this event.
    const [event, name] = packet.data;
    say(...(event === 'gcode:load' ? [event, name] : packet.data));
    handle.call(socket, packet);
  };
  for await (const line of createInterface({ input: process.stdin })) {
    const [event, ...args] = JSON.parse(line);
    if (event === 'open' || event === 'close') {
      // These are answered.
      args.push((why) => say(`${event}:done`, String(why ?? '')));
    }
    socket.emit(event, ...args);
  }
  socket.close();
}

main();
