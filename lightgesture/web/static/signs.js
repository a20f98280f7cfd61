"use strict";
let language = null;
let latest = { sentence: "", expected: [] };

const byId = (id) => document.getElementById(id);
const kindOf = () => (byId("gloved").checked ? "gloved" : "bare");

function showAll() {
  byId("note").textContent = language.note;
  byId("all").replaceChildren(...language.words.map((entry) => drawnWord(entry, language, kindOf())));
  const lines = language.said.map((line) => element("p", line.trim(), line.startsWith(" ") ? "" : "title"));
  byId("said").replaceChildren(...lines);
  showNow();
}

function showNow() {
  byId("sentence").textContent = latest.sentence || "none";
  byId("sentence").className = latest.sentence ? "" : "none";
  if (language === null) return;
  const next = language.words.filter((entry) => latest.expected.includes(entry.word));
  byId("now").replaceChildren(...next.map((entry) => drawnWord(entry, language, kindOf())));
  for (const item of byId("all").children) item.classList.toggle("next", latest.expected.includes(item.dataset.word));
}

function tell(text, level) {
  byId("link").textContent = text;
  byId("link").dataset.level = level;
}

function listen() {
  const events = new EventSource("/events");
  events.addEventListener("state", (event) => {
    const state = JSON.parse(event.data);
    const isNew = state.sentence !== latest.sentence || String(state.expected) !== String(latest.expected);
    latest = state;
    tell(state.ended === null ? state.state : "the stream has ended", state.ended === null ? "good" : "bad");
    if (isNew) showNow();
  });
  events.addEventListener("error", () => {
    tell("not connected", "bad");
    if (events.readyState === EventSource.CLOSED) setTimeout(listen, 2000);
  });
}

async function begin() {
  const answer = await fetch("/signs.json");
  if (!answer.ok) { byId("note").textContent = "this server was not told its language"; return; }
  language = await answer.json();
  showAll();
}

byId("gloved").addEventListener("change", () => { if (language) showAll(); });
begin();
listen();
