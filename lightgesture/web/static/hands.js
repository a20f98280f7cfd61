"use strict";
// Drawn hands, for the pages of signs and of practice. Everything from the decoder is put in as text.
function element(tag, text, name) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (name) made.className = name;
  return made;
}

function drawnHand(token, side, language, kind) {
  const label = side + " hand: " + token;
  if (!language.drawn.includes(token)) {
    const name = element("span", token, "hand named");
    name.setAttribute("aria-label", label);
    return name;
  }
  const picture = element("img", undefined, "hand " + side);
  picture.src = "/hands/" + encodeURIComponent(token) + "-" + kind + ".svg";
  picture.alt = label;
  [picture.width, picture.height] = [80, 80];
  return picture;
}

function drawnPair(pair, language, kind) {
  const both = element("span", undefined, "pair");
  both.append(drawnHand(pair[0], "left", language, kind), drawnHand(pair[1], "right", language, kind));
  return both;
}

function drawnWord(entry, language, kind) {
  const item = element("li", undefined, "sign");
  item.dataset.word = entry.word;
  item.append(drawnPair(entry.pairs[0], language, kind), element("strong", entry.word));
  item.append(element("small", entry.pairs.map((pair) => pair.join(",")).join(" or ")));
  return item;
}
