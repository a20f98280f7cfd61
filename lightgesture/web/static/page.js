"use strict";
// Everything that comes from the decoder is put in as text, never as markup.
const at = (id) => document.getElementById(id);
const MOST_ENTRIES = 200;
const SILENT_MS = 5000;
const RETRY_MS = 2000;
const FRESH_S = 5;
let run = null;
let heard = 0;
let paused = false;
let audio = null;
const UNREAD = { low_confidence: "unsure", unknown_shape: "no sign", partial: "cut off", occluded: "covered" };
const KINDS = { instruction: "accepted", rejected: "rejected", notice: "notice", vehicle: "vehicle" };
const TONES = { instruction: [660, 880], rejected: [220, 165] };
const TONE_S = 0.14;

function tell(text, level, stale) {
  document.body.classList.toggle("stale", Boolean(stale));
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
  const read = item.token === null ? "not read (" + (UNREAD[item.reason] ?? String(item.reason).replaceAll("_", " ")) + ")" : item.token;
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
  if (run !== null && state.run !== run) { at("entries").replaceChildren(); at("last").hidden = true; showPicture(); }
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
  put("tasks", state.tasks.length ? "under way: " + state.tasks.join(", ") : "");
  if (state.ended !== null) tell("the stream has ended" + (state.ended === "ok" ? "" : " (" + state.ended + ")"), "bad", true);
  else if (state.picture_age_s === null) tell("no picture yet", "bad");
  else if (state.picture_age_s > 2) tell("no picture for " + Math.round(state.picture_age_s) + " s", "bad", true);
  else tell(state.state, "good");
}

function line(tag, text) {
  const element = document.createElement(tag);
  element.textContent = text;
  return element;
}

function play(tones) {
  if (audio === null || tones === undefined) return;
  tones.forEach((frequency, place) => {
    const start = audio.currentTime + place * TONE_S;
    const tone = new OscillatorNode(audio, { frequency });
    const volume = new GainNode(audio, { gain: 0.2 });
    volume.gain.setTargetAtTime(0, start + TONE_S * 0.7, 0.02);
    tone.connect(volume).connect(audio.destination);
    tone.start(start);
    tone.stop(start + TONE_S);
  });
}

function showLast(entry, more) {
  at("last").hidden = false;
  at("last").className = entry.type;
  put("last-text", entry.text ?? entry.detail);
  put("last-more", more);
}

function showEntry(entry) {
  if (document.querySelector('[data-number="' + Number(entry.number) + '"]')) return;
  const item = document.createElement("li");
  item.className = entry.type;
  if (entry.state === "refused" || entry.state === "aborted") item.classList.add("rejected");
  item.dataset.number = Number(entry.number);
  const clock = new Date(entry.wall_s * 1000).toLocaleTimeString([], { hour12: false });
  const said = entry.type === "vehicle" ? entry.state + " " + (entry.instruction ?? "") : entry.text;
  item.append(line("strong", said ?? entry.detail));
  const more = [clock, KINDS[entry.type]];
  if (entry.type === "instruction") more.push("confidence " + entry.confidence.toFixed(2));
  if (entry.type === "rejected" || entry.type === "vehicle") more.push(entry.detail);
  item.append(line("span", more.join(" · ")));
  showLast(entry, more.join(" · "));
  // What was there before the page was opened makes no sound.
  if (Date.now() / 1000 - entry.wall_s < FRESH_S) play(TONES[entry.type]);
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
    tell("not connected", "bad", true);
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
setInterval(() => { if (heard && Date.now() - heard > SILENT_MS) tell("the decoder is silent", "bad", true); }, 1000);
at("sound").addEventListener("change", () => {
  // Browsers allow sound only from what the user does.
  if (at("sound").checked) { audio = new AudioContext(); play(TONES.instruction); } else { audio?.close(); audio = null; }
});
showPicture();
listen();
