// SPDX-License-Identifier: GPL-3.0-or-later
// What the server says and takes. The token comes with the address, and stays in this tab.
const key = "mesofit-token";

function findToken() {
  const given = new URLSearchParams(location.search).get("token");
  if (given) {
    sessionStorage.setItem(key, given);
    history.replaceState(null, "", location.pathname);
  }
  return given || sessionStorage.getItem(key) || "";
}
const token = findToken();

export function path(name, query = {}) {
  const text = new URLSearchParams(query).toString();
  return "/api/" + name + (text ? "?" + text : "");
}

export async function ask(name, query, options = {}) {
  const answer = await fetch(path(name, query), {
    ...options, headers: { "X-Mesofit-Token": token }, cache: "no-store" });
  if (!answer.ok)
    throw new Error(await answer.text());
  return answer;
}

export const getText = async (name, query) => (await ask(name, query)).text();
export const getJson = async (name, query) => (await ask(name, query)).json();
export const post = async (name, query, body = "") =>
  (await ask(name, query, { method: "POST", body })).text();

// Events as they come, until `stop` or the end of the server.
async function readEvents(take, signal) {
  const answer = await ask("events", {}, { signal });
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done)
      return;
    text += value;
    for (let end; (end = text.indexOf("\n\n")) >= 0; text = text.slice(end + 2))
      takeEvent(text.slice(0, end), take);
  }
}

function takeEvent(text, take) {
  let name = "";
  const data = [];
  for (const line of text.split("\n"))
    if (line.startsWith("event: "))
      name = line.slice(7);
    else if (line.startsWith("data: "))
      data.push(line.slice(6));
  if (name)
    take(name, data.join("\n"));
}

// Listen, and again after an interruption unless it was the end; `gone` is told when the server does not answer.
export function listen(take, gone, isOver) {
  const control = new AbortController();
  let failures = 0;
  const again = async () => {
    while (!control.signal.aborted) {
      try {
        await readEvents((name, data) => { failures = 0; take(name, data); }, control.signal);
        if (isOver())
          return;
        failures++;
      } catch (error) {
        failures++;
        if (!control.signal.aborted)
          gone(error, failures);
      }
      if (failures > 5)
        return;
      await new Promise((done) => setTimeout(done, 300 * failures));
    }
  };
  again();
  return () => control.abort();
}

// A file for the person to keep.
export async function download(name, query, file) {
  const url = URL.createObjectURL(await (await ask(name, query)).blob());
  const link = document.createElement("a");
  link.href = url;
  link.download = file;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}
