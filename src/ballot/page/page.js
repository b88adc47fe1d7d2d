// The server is the truth: this page shows its state, asked for about once a second, and sends a
// vote until the server has confirmed it. Nothing is remembered but choices that are not sent yet.
"use strict";

const POLL_MS = 1000;
const PATIENCE_MS = 6000;
const KINDS = ["best", "second", "least"];
const NAMES = { best: "Best", second: "Second best", least: "Least liked" };

const one = (selector) => document.querySelector(selector);
const all = (selector) => [...document.querySelectorAll(selector)];

let state = null;      // as the server told it last
let choices = {};      // of the round on screen
let editing = false;   // a vote that was received is being changed
let sending = false;
let describing = false;  // placing looks on scales
let place = 0;           // of the question on screen: look by look, scale by scale
let shownRound = 0;
let shownView = "loading";
let timer = 0;
let asking = null;     // the poll that is on its way

async function ask(path, options) {
    const stop = new AbortController();
    const patience = setTimeout(() => stop.abort(), PATIENCE_MS);
    try {
        const answer = await fetch(path, {
            cache: "no-store", credentials: "same-origin", redirect: "error", signal: stop.signal,
            ...options,
        });
        const text = await answer.text();
        return { status: answer.status, json: text ? JSON.parse(text) : {} };
    } finally {
        clearTimeout(patience);
    }
}

function send(method, path, value) {
    return ask(path, {
        method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(value),
    });
}

// --- choices ---

const memory = (round) => "livery-choices-" + round;

function remember() {
    try {
        sessionStorage.setItem(memory(state.round), JSON.stringify(choices));
    } catch (problem) {
        // A browser that keeps nothing: a reload asks again.
    }
}

function recall(round) {
    try {
        const kept = JSON.parse(sessionStorage.getItem(memory(round)));
        return kept && typeof kept === "object" ? kept : {};
    } catch (problem) {
        return {};
    }
}

const isDuel = () => state.codes.length === 2;
const complete = () => choices.best && (isDuel() || choices.second);

function choose(kind, code) {
    choices[kind] = code;
    for (const other of KINDS) {
        if (other !== kind && choices[other] === code) delete choices[other];
    }
    remember();
    showChoices();
}

function makeChoices(kind, codes, withNone) {
    const place = one(`#${kind} .choices`);
    place.replaceChildren();
    place.classList.toggle("few", codes.length <= 4 && !withNone);
    for (const code of withNone ? [...codes, 0] : codes) {
        const label = document.createElement("label");
        label.className = "choice";
        const input = document.createElement("input");
        input.type = "radio";
        input.name = kind;
        input.value = code;
        input.addEventListener("change", () => choose(kind, code));
        const text = document.createElement("span");
        text.textContent = code === 0 ? "None" : code;
        label.append(input, text);
        place.append(label);
    }
}

function showChoices() {
    for (const kind of KINDS) {
        const before = KINDS.slice(0, KINDS.indexOf(kind)).map((other) => choices[other]);
        for (const input of all(`#${kind} input`)) {
            const code = Number(input.value);
            input.checked = (choices[kind] || 0) === code;
            // What is chosen above cannot be chosen again.
            input.disabled = code !== 0 && before.includes(code);
        }
    }
    const missing = !choices.best ? "Choose the best."
        : !isDuel() && !choices.second ? "Choose the second best." : "";
    one("#missing").textContent = missing;
    const ready = complete() && !sending;
    one("#send").setAttribute("aria-disabled", String(!ready));
    one("#send").textContent = sending ? "Sending…" : "Send";
}

// --- scales: after the ballot, as far as one likes ---

const STEPS = ["very", "quite", "slightly", "", "slightly", "quite", "very"];

function stepName(step, words) {
    if (step === 4) return "neither, or both";
    return `${STEPS[step - 1]} ${words[step < 4 ? 0 : 1]}`;
}

const questions = (told) => told.codes.length * told.scales.length;
const lookAt = (told) => told.codes[Math.floor(place / told.scales.length)];
const scaleAt = (told) => place % told.scales.length;
const stepsOf = (told, look) => told.ratings[look] || told.scales.map(() => null);

let askedOf = "";
function showScales(told) {
    one("#more").hidden = !told.scales;
    if (!told.scales || !told.codes) return;
    const answers = told.codes.flatMap((look) => stepsOf(told, look)).filter((step) => step !== null).length;
    one("#answered").textContent = `${answers} of ${questions(told)} answered. You may change them until the round is locked.`;
    one("#describe").textContent = answers ? "Go on describing" : "Describe the looks";
    const look = lookAt(told), words = told.scales[scaleAt(told)];
    const step = stepsOf(told, look)[scaleAt(told)];
    one("#look").textContent = "Look " + look;
    one("#progress").textContent = `Question ${place + 1} of ${questions(told)}`;
    one("#words").textContent = `${words[0]} or ${words[1]}?`;
    const asked = JSON.stringify([told.round, place, words]);
    if (asked !== askedOf) {
        askedOf = asked;
        const list = one(".steps");
        list.replaceChildren();
        for (let number = 1; number <= 7; ++number) {
            // Buttons: the arrow keys of a group of radios would answer on their way.
            const button = document.createElement("button");
            button.type = "button";
            button.className = "quiet step";
            button.value = number;
            button.addEventListener("click", () => answer(number));
            button.textContent = stepName(number, words);
            list.append(button);
        }
    }
    for (const button of all(".step")) {
        button.setAttribute("aria-pressed", String(Number(button.value) === step));
    }
    one("#before").setAttribute("aria-disabled", String(place === 0));
    one("#after").textContent = step === null ? "Skip" : "Next";
    one("#take-back").hidden = step === null;
}

function goTo(next) {
    one("#scale-problem").textContent = "";
    if (next < 0) return;
    place = next;
    if (place >= questions(state)) {
        place = 0;
        describing = false;
    }
    showScales(state);
    showView(viewOf(state));
    scrollTo(0, 0);
}

let answering = false;
async function answer(step) {
    if (answering || state.state !== "voting") return;
    answering = true;
    const round = state.round, look = lookAt(state), from = place;
    const steps = [...stepsOf(state, look)];
    steps[scaleAt(state)] = step;
    try {
        while (state.state === "voting" && state.round === round) {
            let told = null;
            try {
                told = await send("PUT", "/scales", { round, look, steps });
            } catch (problem) {
                say("Not received yet. Trying again…");
            }
            if (told && told.status === 200) {
                say("");
                show(told.json);
                if (step !== null && describing && place === from) goTo(place + 1);
                return;
            }
            if (told && told.status !== 503 && told.status !== 429) {
                one("#scale-problem").textContent = told.json.problem || "Not received.";
                return;
            }
            if (told) say(told.json.problem);
            await new Promise((done) => setTimeout(done, 1500));
        }
    } finally {
        answering = false;
        if (state.scales) showScales(state);
    }
}

// --- what is on screen ---

const ORDINALS = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"];

function showGroup(told) {
    if (!told.wave) return;
    const ordinal = ORDINALS[told.wave - 1];
    one("#group").textContent = ordinal ? `You are in the ${ordinal} group` : `You are in group ${told.wave}`;
    one("#turn").textContent = told.wave === 1 ? `Your turn comes first of ${told.waves} groups.`
        : told.wave === 2 ? `Your turn comes when the first group has seen the looks. There are ${told.waves} groups.`
        : `Your turn comes when the groups before you have seen the looks. There are ${told.waves} groups.`;
}

function viewOf(told) {
    if (told.state === "waiting" && told.wave) return "later";
    if (told.state === "voting" && told.ballot && !editing && !sending) {
        return describing && told.scales ? "scales" : "received";
    }
    return told.state;
}

function showMine(ballot, receipt) {
    for (const list of all(".mine")) {
        list.replaceChildren();
        for (const kind of KINDS) {
            if (!ballot || !ballot[kind]) continue;
            const term = document.createElement("dt");
            term.textContent = NAMES[kind];
            const value = document.createElement("dd");
            value.textContent = ballot[kind];
            list.append(term, value);
        }
    }
    const readable = receipt ? (receipt.slice(0, 4) + " " + receipt.slice(4)).toUpperCase() : "";
    for (const place of all(".receipt")) place.textContent = readable;
    one(".receipt-line").hidden = !receipt;
    one("#counted").textContent = ballot ? "Your vote counts." : "No vote of yours is in it.";
}

function show(told) {
    const before = JSON.stringify(state);
    const seatBefore = state && state.seat;
    state = told;
    if (told.round !== shownRound || (seatBefore && told.seat !== seatBefore)) {
        shownRound = told.round;
        editing = describing = false;
        choices = {};
        place = 0;
    }
    if (told.state === "voting" && !all("#best input").length ||
        before !== JSON.stringify(told)) {
        if (told.codes) {
            choices = Object.keys(choices).length ? choices : recall(told.round);
            for (const kind of KINDS) if (!told.codes.includes(choices[kind])) delete choices[kind];
            makeIfNew(told);
        }
        one("#seat").textContent = told.seat ? "Seat " + told.seat : "";
        showMine(told.ballot, told.receipt);
        showGroup(told);
        showScales(told);
    }
    if (told.state === "voting") showChoices();
    showView(viewOf(told));
}

let madeOf = "";
function makeIfNew(told) {
    const made = JSON.stringify([told.round, told.codes, told.least]);
    if (made === madeOf) return;
    madeOf = made;
    for (const kind of KINDS) makeChoices(kind, told.codes, kind === "least");
    one("#second").hidden = told.codes.length === 2;
    one("#least").hidden = !told.least || told.codes.length < 3;
}

function showView(view) {
    if (view === shownView) return;
    const old = shownView;
    shownView = view;
    for (const section of all("section")) section.hidden = section.dataset.view !== view;
    for (const place of all(".problem")) place.textContent = "";
    scrollTo(0, 0);
    // A screen reader goes on where something new is.
    if (old !== "loading") one(`section[data-view=${view}] h2`).focus({ preventScroll: true });
}

function say(text) {
    const place = one("#connection");
    if (place.textContent !== text) place.textContent = text;
}

// --- asking ---

async function poll() {
    clearTimeout(timer);
    if (asking || document.hidden) return;
    asking = ask("/state");
    try {
        const { status, json } = await asking;
        if (status !== 200) throw new Error(json.problem);
        say("");
        show(json);
    } catch (problem) {
        say("No connection. Trying again…");
    } finally {
        asking = null;
        clearTimeout(timer);
        timer = setTimeout(poll, POLL_MS);
    }
}

async function submitVote() {
    if (sending || !complete()) return;
    sending = true;
    one("#vote-problem").textContent = "";
    showChoices();
    const round = state.round;
    const vote = { round, best: choices.best, least: choices.least || null };
    vote.second = isDuel() ? state.codes.find((code) => code !== vote.best) : choices.second;
    try {
        // The same vote may arrive twice: it is one.
        while (state.state === "voting" && state.round === round) {
            let answer = null;
            try {
                answer = await send("PUT", "/ballot", vote);
            } catch (problem) {
                say("Not received yet. Trying again…");
            }
            if (answer && answer.status === 200) {
                say("");
                sending = editing = false;
                show(answer.json);
                return;
            }
            if (answer && answer.status !== 503 && answer.status !== 429) {
                one("#vote-problem").textContent = answer.json.problem || "Not received.";
                return;
            }
            if (answer) say(answer.json.problem);
            await new Promise((done) => setTimeout(done, 1500));
        }
    } finally {
        sending = false;
        showChoices();
        poll();
    }
}

one("#vote").addEventListener("submit", (event) => {
    event.preventDefault();
    submitVote();
});

one("#describe").addEventListener("click", () => {
    // Where the first answer is missing.
    const open = state.codes.flatMap((look) => stepsOf(state, look)).indexOf(null);
    describing = true;
    goTo(Math.max(0, open));
});
one("#before").addEventListener("click", () => goTo(place - 1));
one("#after").addEventListener("click", () => goTo(place + 1));
one("#take-back").addEventListener("click", () => answer(null));
one("#enough").addEventListener("click", () => goTo(questions(state)));

one("#change").addEventListener("click", () => {
    editing = true;
    choices = {};
    for (const kind of KINDS) if (state.ballot[kind]) choices[kind] = state.ballot[kind];
    remember();
    show(state);
});

one("#join").addEventListener("submit", async (event) => {
    event.preventDefault();
    const place = one("#join-problem");
    place.textContent = "";
    try {
        const { status, json } = await send("POST", "/join", { code: one("#code").value });
        if (status !== 200) {
            place.textContent = json.problem || "Not let in.";
            return;
        }
        one("#code").value = "";
    } catch (problem) {
        place.textContent = "No connection. Try again.";
    }
    poll();
});

// Awake again, or back by the back button: what is on screen may be old.
document.addEventListener("visibilitychange", poll);
addEventListener("pageshow", poll);
addEventListener("online", poll);
poll();
