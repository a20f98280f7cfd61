"use strict";
// Everything that comes from the decoder is put in as text, never as markup.
const at = (id) => document.getElementById(id);
const MOST_ENTRIES = 200;
const SILENT_MS = 5000;
const RETRY_MS = 2000;
let run = null;
let heard = 0;
let paused = false;

function tell(text, level) {
  if (at("link").textContent !== text) at("link").textContent = text;
  at("link").dataset.level = level;
}

function showPicture() {
  // A name of its own, or a browser may go on with the connection that broke.
  if (!paused) at("picture").src = "/stream.mjpg?" + Date.now();
}

function put(id, text) {
  if (at(id).textContent !== text) at(id).textContent = text;
}

function hand(item) {
  const read = item.token === null ? "not read (" + String(item.reason).replaceAll("_", " ") + ")" : item.token;
  return item.side + " hand: " + read;
}

function card(item) {
  return (item.side ? item.side + " card: " : "card: ") + (item.word ?? "tag " + Number(item.id) + ", no word");
}

function seen(state) {
  if (state.signs) return state.signs.length ? state.signs.map(card).join("; ") : "no cards";
  return state.hands.length ? state.hands.map(hand).join("; ") : "no hands";
}

function showState(state) {
  if (run !== null && state.run !== run) { at("entries").replaceChildren(); showPicture(); }
  run = state.run;
  put("source", state.source ?? "");
  put("sentence", state.sentence || "none");
  at("sentence").className = state.sentence ? "" : "none";
  const dwell = state.dwell;
  put("dwell-label", dwell ? dwell.pair.join(" and ") + ": " + (dwell.word ?? "no word") : "no sign is held");
  at("dwell").value = dwell ? dwell.progress : 0;
  put("hands", seen(state));
  const numbers = [];
  if (state.frames !== undefined) numbers.push(state.frames + " pictures decoded", state.dropped + " passed over",
    state.ms_per_frame.toFixed(1) + " ms a picture");
  put("numbers", numbers.join(", "));
  if (state.ended !== null) tell("the stream has ended (" + state.ended + ")", "bad");
  else if (state.picture_age_s === null) tell("no picture yet", "bad");
  else if (state.picture_age_s > 2) tell("no picture for " + Math.round(state.picture_age_s) + " s", "bad");
  else tell(state.state, "good");
}

function line(tag, text) {
  const element = document.createElement(tag);
  element.textContent = text;
  return element;
}

function showEntry(entry) {
  if (document.querySelector('[data-number="' + Number(entry.number) + '"]')) return;
  const item = document.createElement("li");
  item.className = entry.type;
  item.dataset.number = Number(entry.number);
  const clock = new Date(entry.wall_s * 1000).toLocaleTimeString([], { hour12: false });
  const kind = { instruction: "accepted", rejected: "rejected", notice: "notice" }[entry.type];
  item.append(line("strong", entry.text ?? entry.detail));
  const more = [clock, kind];
  if (entry.type === "instruction") more.push("confidence " + entry.confidence.toFixed(2));
  if (entry.type === "rejected") more.push(entry.detail);
  item.append(line("span", more.join(" · ")));
  at("entries").prepend(item);
  while (at("entries").childElementCount > MOST_ENTRIES) at("entries").lastElementChild.remove();
  at("nothing").hidden = true;
}

function listen() {
  const events = new EventSource("/events");
  const take = (show) => (event) => { heard = Date.now(); show(JSON.parse(event.data)); };
  events.addEventListener("state", take(showState));
  events.addEventListener("entry", take(showEntry));
  // A browser gives up by itself where the server answers that it is full.
  events.addEventListener("error", () => {
    tell("not connected", "bad");
    if (events.readyState === EventSource.CLOSED) setTimeout(listen, RETRY_MS);
  });
}

at("picture").addEventListener("error", () => { if (!paused) setTimeout(showPicture, RETRY_MS); });
at("pause").addEventListener("click", () => {
  paused = !paused;
  at("pause").setAttribute("aria-pressed", String(paused));
  const picture = at("picture");
  picture.hidden = paused;
  if (!paused) { at("still")?.remove(); showPicture(); return; }
  // The last picture stays as a still, and the stream is let go.
  const still = document.createElement("canvas");
  still.id = "still";
  still.setAttribute("role", "img");
  still.setAttribute("aria-label", "The camera's picture, paused");
  [still.width, still.height] = [picture.naturalWidth || 640, picture.naturalHeight || 480];
  if (picture.naturalWidth) still.getContext("2d").drawImage(picture, 0, 0);
  picture.after(still);
  picture.removeAttribute("src");
});
setInterval(() => { if (heard && Date.now() - heard > SILENT_MS) tell("the decoder is silent", "bad"); }, 1000);
showPicture();
listen();
