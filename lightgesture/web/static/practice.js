"use strict";
const RETRY_MS = 2000;
const SIDES = ["left", "right"];
const byId = (id) => document.getElementById(id);
let language = null;
let latest = null;
let shown = "";

function put(id, text) {
  if (byId(id).textContent !== text) byId(id).textContent = text;
}

function tell(text, level) {
  put("link", text);
  byId("link").dataset.level = level;
}

function counted(number, noun) {
  return number + " " + noun + (number === 1 ? "" : "s");
}

function step(sign, place, now) {
  const item = element("li", undefined, place < now ? "done" : place === now ? "now" : "");
  item.append(language === null ? element("span", sign.pair.join(",")) : drawnPair(sign.pair, language, "bare"));
  item.append(element("strong", sign.word));
  item.append(element("small", place < now && sign.seconds !== null ? sign.seconds.toFixed(1) + " s" : sign.pair.join(",")));
  return item;
}

function showTask(practice) {
  put("sentence", practice.sentence ?? "all done");
  // Drawn anew only when another sign is asked for, so that nothing flickers.
  const signature = [practice.number, practice.place, language !== null].join();
  if (signature !== shown) {
    shown = signature;
    byId("steps").replaceChildren(...(practice.signs ?? []).map((sign, place) => step(sign, place, practice.place)));
  }
  put("last", practice.last ? practice.last[1] : "");
  byId("last").className = practice.last ? practice.last[0] : "";
  const numbers = practice.is_done ? "" : "sentence " + practice.number + " of " + practice.of + ", " + practice.elapsed_s + " s, "
    + counted(practice.mistakes, "mistake") + ", " + counted(practice.slips, "slip");
  put("count", numbers);
  const lines = practice.results.map((line) => element("li", line[0], line[1] ? "done" : "missed"));
  if (practice.summary) lines.push(...practice.summary.map((line) => element("li", line.trim())));
  if (byId("results").childElementCount !== lines.length) byId("results").replaceChildren(...lines);
  byId("nothing").hidden = lines.length > 0;
}

function showHands(state, practice) {
  const asked = practice.signs ? practice.signs[practice.place].pair : [null, null];
  // The last sign is held on for a moment; that is not wrong.
  const before = practice.signs && practice.place ? practice.signs[practice.place - 1].pair : [null, null];
  for (const [place, side] of SIDES.entries()) {
    const hand = state.hands.find((one) => one.side === side);
    const read = hand === undefined ? "not in view" : hand.token ?? "not read";
    put(side, read);
    put(side + "-asked", asked[place] === null ? "" : "asked: " + asked[place]);
    const box = byId(side).parentElement;
    box.classList.toggle("right-sign", hand !== undefined && asked[place] !== null && hand.token === asked[place]);
    const isWrong = hand !== undefined && asked[place] !== null && ![asked[place], before[place]].includes(hand.token);
    box.classList.toggle("wrong-sign", isWrong);
  }
  const dwell = state.dwell;
  put("dwell-label", dwell ? dwell.pair.join(" and ") + ": " + (dwell.word ?? "no word") : "no sign is held");
  byId("dwell").value = dwell ? dwell.progress : 0;
}

function showState(state) {
  latest = state;
  if (state.practice === undefined) { tell("no practice runs here", "bad"); return; }
  showTask(state.practice);
  showHands(state, state.practice);
  if (state.practice.is_done) tell("done", "good");
  else if (state.picture_age_s === null) tell("no picture yet", "bad");
  else if (state.picture_age_s > 2) tell("no picture for " + Math.round(state.picture_age_s) + " s", "bad");
  else tell("watching", "good");
}

function showPicture() {
  byId("picture").src = "/stream.mjpg?" + Date.now();
}

function listen() {
  const events = new EventSource("/events");
  events.addEventListener("state", (event) => showState(JSON.parse(event.data)));
  events.addEventListener("error", () => {
    tell("not connected", "bad");
    if (events.readyState === EventSource.CLOSED) setTimeout(listen, RETRY_MS);
  });
}

async function begin() {
  const answer = await fetch("/signs.json");
  if (!answer.ok) return;
  language = await answer.json();
  if (latest !== null) showState(latest);
}

byId("picture").addEventListener("error", () => setTimeout(showPicture, RETRY_MS));
begin();
showPicture();
listen();
