"use strict";
// Everything that comes from the decoder is put in as text, never as markup.
const at = (id) => document.getElementById(id);
const WORDS = { accepted: "OK", refused: "NO", done: "DONE", repeat: "AGAIN" };
const LONG = 12;
const SILENT_MS = 5000;
const RETRY_MS = 2000;
let state = null;
let heard = 0;
let reason = "";

function show(mood, word, more) {
  document.body.dataset.mood = mood;
  at("word").className = word.length > LONG ? "long" : "";
  if (at("word").textContent !== word) at("word").textContent = word;
  if (at("more").textContent !== more) at("more").textContent = more;
}

function draw() {
  const silent = Date.now() - heard;
  if (state === null || silent > SILENT_MS || state.ended !== null) return show("lost", "no link", "");
  at("dwell").value = state.dwell ? state.dwell.progress : 0;
  const answer = state.answer;
  const task = state.tasks.join(", ");
  if (answer && answer.age_s + silent / 1000 < answer.shown_s) return show(answer.answer, WORDS[answer.answer], reason);
  if (state.sentence) return show("busy", state.sentence, state.dwell?.word ?? "");
  if (task) return show("busy", task, "");
  return show("idle", "ready", state.dwell?.word ?? "");
}

function listen() {
  const events = new EventSource("/events");
  events.addEventListener("state", (event) => { heard = Date.now(); state = JSON.parse(event.data); draw(); });
  events.addEventListener("entry", (event) => {
    const entry = JSON.parse(event.data);
    reason = entry.type === "instruction" ? entry.text : entry.detail;
    draw();
  });
  events.addEventListener("error", () => { if (events.readyState === EventSource.CLOSED) setTimeout(listen, RETRY_MS); });
}

setInterval(draw, 200);
listen();
