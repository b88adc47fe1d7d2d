#!/usr/bin/env python3
"""The phone page in Chromium, 390 x 844: three taps, reload, back, sleep, double submit, twelve seats; contrast,
sizes of targets, labels and the keyboard's order, computed from the page.

    tests/ballot/page.py build/release/bin/livery-ballots build/release/bin/ballot_operator
    LIVERY_BALLOT_PICTURES=docs/images tests/ballot/page.py ...     keeps the pictures of the documents"""
import os
import sys
import time

from browser import Browser, find_browser, png_pixels
from server import check, serving

PICTURES = os.environ.get("LIVERY_BALLOT_PICTURES")
SEATS = 12
IN_DOCUMENTS = ("join", "chosen", "received", "scales", "later", "locked")

# What is on screen with text: colours as [r, g, b], the ground that shows through, and what it says.
TEXTS = """(() => {
  const rgb = (text) => { const n = text.match(/[0-9.]+/g).map(Number); return n.length < 4 ? [...n, 1] : n; };
  const found = [];
  for (const e of document.querySelectorAll("body *")) {
    const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || e.matches("input[type=text]");
    if (!own || !e.getClientRects().length) continue;
    let ground = e;
    while (ground && rgb(getComputedStyle(ground).backgroundColor)[3] === 0) ground = ground.parentElement;
    found.push({ text: e.textContent.trim() || e.id, color: rgb(getComputedStyle(e).color),
                 ground: rgb(getComputedStyle(ground || document.documentElement).backgroundColor) });
  }
  return found;
})()"""

TARGETS = """[...document.querySelectorAll("button, input, a")].filter((e) => e.getClientRects().length).map((e) => {
  const r = e.getBoundingClientRect();
  return { what: e.id || e.name + e.value, x: r.x, y: r.y, width: r.width, height: r.height };
})"""


def luminance(color):
    linear = [c / 255 / 12.92 if c / 255 <= 0.04045 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in color[:3]]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    """WCAG 2.1."""
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


class Figures:
    contrast, target = 99.0, 999.0


def look_at(tab, name):
    """What must hold of every view; a picture of it for the documents."""
    texts = tab.js(TEXTS)
    check(texts, f"{name}: nothing is written on it")
    for text in texts:
        for color in (text["color"], text["ground"]):
            check(color[3] == 1 and max(color[:3]) - min(color[:3]) <= 0, f"{name}: {text} is not grey")
        ratio = contrast(text["color"], text["ground"])
        check(ratio >= 7, f"{name}: contrast {ratio:.1f} of {text}")
        Figures.contrast = min(Figures.contrast, ratio)
    targets = tab.js(TARGETS)
    for target in targets:
        check(min(target["width"], target["height"]) >= 56, f"{name}: target {target}")
        check(target["x"] >= 0 and target["x"] + target["width"] <= 390, f"{name}: beyond the screen: {target}")
        Figures.target = min(Figures.target, target["width"], target["height"])
    for k, one in enumerate(targets):
        for other in targets[k + 1:]:
            apart = (one["x"] + one["width"] <= other["x"] or other["x"] + other["width"] <= one["x"] or
                     one["y"] + one["height"] <= other["y"] or other["y"] + other["height"] <= one["y"])
            check(apart, f"{name}: {one} lies on {other}")
    check(tab.js("document.documentElement.scrollWidth") <= 390, f"{name}: it scrolls sideways")
    check(tab.js("document.querySelectorAll('img, svg, canvas, video, picture').length") == 0, f"{name}: a picture")
    # Something has the name that a screen reader says.
    nodes = tab.call("Accessibility.getFullAXTree")["nodes"]
    for node in nodes:
        role = node.get("role", {}).get("value")
        if role in ("button", "radio", "textbox", "group", "heading", "link") and not node.get("ignored"):
            check(node.get("name", {}).get("value"), f"{name}: a {role} without a name")
    # What the style sheet does not say, such as a browser's mark of a finger.
    pixels = set(png_pixels(tab.picture(0.25)))
    check(len(pixels) > 10, f"{name}: nothing to be seen")
    coloured = [pixel for pixel in pixels if max(pixel) - min(pixel) > 2]
    check(not coloured, f"{name}: pixels with colour, as {coloured[:3]}")
    if PICTURES and name in IN_DOCUMENTS:
        with open(os.path.join(PICTURES, f"phone-{name}.png"), "wb") as out:
            out.write(tab.picture(0.5))


def clean(tab, origin):
    """No request left the page, and it met no error but those that the test made."""
    for request in tab.events("Network.requestWillBeSent"):
        url = request["request"]["url"]
        check(url.startswith(origin), f"a request to {url}")
    check(not tab.events("Runtime.exceptionThrown"), f"{tab.events('Runtime.exceptionThrown')}")
    for entry in tab.events("Log.entryAdded"):
        # The browser asks for an icon by itself, and failed requests are the test's.
        check(entry["entry"]["source"] in ("network", "other"), f"{entry}")


def choice(kind, code):
    return f"#{kind} input[value='{code}']"


def receipt(tab):
    return tab.js("document.querySelector('section[data-view=received] .receipt').textContent")


def keyboard(tab, codes):
    """Tab goes from group to group to the button; arrows choose; Enter sends."""
    order = []
    tab.js("document.activeElement.blur()")
    for _ in range(3):
        tab.key("Tab", number=9)
        order.append(tab.js("document.activeElement.name || document.activeElement.id"))
    check(order == ["best", "second", "send"], f"tab order: {order}")
    tab.js(f"document.querySelector(\"{choice('best', codes[0])}\").focus()")
    tab.key(" ", "Space", 32, " ")
    tab.key("ArrowDown", number=40)
    check(tab.js("document.querySelector('#best input:checked').value") == str(codes[1]), "arrows do not choose")
    check(tab.js(f"document.querySelector(\"{choice('second', codes[1])}\").disabled"), "best can be second best too")
    # From the last, which is chosen, round to the first.
    tab.key("Tab", number=9)
    tab.key("ArrowDown", number=40)
    check(tab.js("document.querySelector('#second input:checked').value") == str(codes[0]), "arrows do not wrap")
    tab.key("Enter", number=13, text="\r")
    tab.wait_for_view("received")


def one_phone(browser, server):
    origin = server.place["url"]
    invitation = server.operator("invitation")
    tab = browser.phone()
    tab.go(origin)
    tab.wait_for_view("join")
    look_at(tab, "join")
    tab.tap("#code")
    tab.call("Input.insertText", text="222222")
    tab.tap("#join button")
    tab.wait("document.querySelector('#join-problem').textContent.includes('not the one')", "a wrong code's answer")
    tab.js("document.querySelector('#code').value = ''")
    tab.tap("#code")
    tab.call("Input.insertText", text=invitation["code"][:4].lower() + " " + invitation["code"][4:])
    tab.tap("#join button")
    tab.wait_for_view("waiting")
    look_at(tab, "waiting")
    check(tab.js("document.cookie") == "", "a script can read the seat")
    round_ = server.operator("open", "a,b,c,d", "present")
    tab.wait_for_view("presenting")
    look_at(tab, "presenting")
    server.operator("voting", round_)
    tab.wait_for_view("voting")
    look_at(tab, "voting")
    codes = tab.js("[...document.querySelectorAll('#best input')].map((e) => Number(e.value))")
    check(codes == sorted(server.operator("show")["rounds"][0]["codes"]), f"codes {codes}")
    check(tab.js("document.documentElement.scrollHeight") <= 844, "four looks do not fit on the screen")

    # Three taps.
    tab.taps = 0
    tab.tap(choice("best", codes[2]))
    tab.tap(choice("second", codes[0]))
    look_at(tab, "chosen")
    tab.tap("#send")
    tab.wait_for_view("received")
    check(tab.taps == 3, f"{tab.taps} taps")
    look_at(tab, "received")
    first = receipt(tab)
    check(len(first) == 9, f"receipt {first}")

    # Reload, and back from another page.
    tab.leave("Page.reload")
    tab.wait_for_view("received")
    check(receipt(tab) == first, "another receipt after a reload")
    tab.go("about:blank")
    tab.wait("location.href === 'about:blank'", "another page")
    tab.leave("Runtime.evaluate", expression="void setTimeout(() => history.back())")
    tab.wait_for_view("received")
    check(receipt(tab) == first, "another receipt after going back")
    check(tab.js("location.pathname") == "/", "no clean address")

    # Changed, and sent twice by an impatient finger; a choice that is not sent survives a reload.
    tab.tap("#change")
    tab.wait_for_view("voting")
    check(tab.js("document.querySelector('#best input:checked').value") == str(codes[2]), "the old choice is gone")
    tab.tap(choice("best", codes[0]))
    check(not tab.js("document.querySelector('#second input:checked')"), "one look is best and second best")
    check(tab.js("document.querySelector('#missing').textContent"), "nobody says what is missing")
    tab.tap(choice("second", codes[3]))
    before = len([r for r in tab.events("Network.requestWillBeSent") if r["request"]["method"] == "PUT"])
    # At once: on a slow machine the first is answered before another message gets there.
    tab.js("for (let k = 0; k < 3; ++k) document.querySelector('#vote').requestSubmit()")
    tab.wait_for_view("received")
    sent = len([r for r in tab.events("Network.requestWillBeSent") if r["request"]["method"] == "PUT"]) - before
    check(sent == 1, f"sent {sent} times")
    check(receipt(tab) != first, "the same receipt for another vote")
    check(server.operator("show")["rounds"][0]["voted"] == [1], "not one vote")

    tab.tap("#change")
    tab.wait_for_view("voting")
    keyboard(tab, codes)

    # The server is killed in between: the page waits, and sends once it is back.
    tab.tap("#change")
    tab.wait_for_view("voting")
    tab.tap(choice("best", codes[3]))
    tab.tap(choice("second", codes[2]))
    server.kill()
    tab.tap("#send")
    tab.wait("document.querySelector('#connection').textContent.includes('rying again')", "word of the lost connection")
    server.start()
    tab.wait_for_view("received")
    last = receipt(tab)

    # Asleep while the round is locked.
    tab.sleep()
    server.operator("lock", round_)
    time.sleep(1.5)
    check(tab.view() == "received", "it did not sleep")
    tab.wake()
    tab.wait_for_view("locked")
    look_at(tab, "locked")
    codes_of = server.operator("show")["rounds"][0]["codes"]
    best, second, kept = server.operator("ballots", round_)["1"]
    check((codes_of[best], codes_of[second]) == (codes[3], codes[2]), "another vote was kept")
    check(last.replace(" ", "").lower() == kept, f"receipt {last}, kept {kept}")

    # A duel takes two taps; a round may ask for the least liked.
    duel = server.operator("open", "a,b")
    tab.wait_for_view("voting")
    look_at(tab, "duel")
    tab.taps = 0
    tab.tap("#best input")
    tab.tap("#send")
    tab.wait_for_view("received")
    check(tab.taps == 2, "a duel takes more than two taps")
    server.operator("lock", duel)
    tab.wait_for_view("locked")
    least = server.operator("open", "a,b,c,d,e,f,g,h", "least")
    tab.wait_for_view("voting")
    tab.tap("#best input")
    tab.tap("#second label:nth-child(2) input")
    tab.tap("#least label:nth-child(3) input")
    look_at(tab, "least")
    tab.tap("#send")
    tab.wait_for_view("received")
    check(tab.js("document.querySelectorAll('section[data-view=received] dd').length") == 3, "no least liked")
    server.operator("lock", least)
    late = browser.phone()
    server.operator("open", "a,b")
    late.go(origin)
    late.wait_for_view("shut")
    look_at(late, "shut")
    server.operator("lock", least + 1)
    for phone in (tab, late):
        clean(phone, origin)


def two_groups(browser, server):
    """Who sits in the second wave is told so, and votes after the first has."""
    server.operator("session")
    invitation = new_invitation(server)
    tabs = [browser.phone() for _ in range(2)]
    for tab in tabs:
        tab.go(f"{server.place['url']}join/{invitation['token']}")
        tab.wait_for_view("waiting")
    round_ = server.operator("open", "a,b,c,d", "waves=2")
    server.operator("sitting", round_, 0, "presenting")
    tabs[0].wait_for_view("presenting")
    tabs[1].wait_for_view("later")
    look_at(tabs[1], "later")
    check("second group" in tabs[1].js("document.querySelector('#group').textContent"), "no word of the group")
    for sitting in range(2):
        server.operator("sitting", round_, sitting, "voting")
        tabs[sitting].wait_for_view("voting")
        if sitting == 0:
            time.sleep(1.5)
            check(tabs[1].view() == "later", "the second group votes with the first")
        tabs[sitting].taps = 0
        tabs[sitting].tap("#best label:nth-child(2) input")
        tabs[sitting].tap("#second label:nth-child(1) input")
        tabs[sitting].tap("#send")
        tabs[sitting].wait_for_view("received")
        check(tabs[sitting].taps == 3, "not three taps")
        if sitting == 0:
            server.operator("sitting", round_, 1, "presenting")
            tabs[1].wait_for_view("presenting")
            check(tabs[0].view() == "received", "the first group cannot change its ballot")
    server.operator("lock", round_)
    for tab in tabs:
        tab.wait_for_view("locked")
        clean(tab, server.place["url"])


def scales(browser, server):
    """After the ballot each look may be placed between two words, whatever the words are; answers may change."""
    server.operator("session")
    tab = browser.phone()
    tab.go(f"{server.place['url']}join/{new_invitation(server)['token']}")
    tab.wait_for_view("waiting")
    wide = "W" * 24
    round_ = server.operator("open", "a,b,c", "scale=cheap,precious", "scale=<b>bold</b>,\"><img src=x>",
                             f"scale={wide},{'m' * 24}")
    tab.wait_for_view("voting")
    codes = tab.js("[...document.querySelectorAll('#best input')].map((e) => Number(e.value))")
    tab.taps = 0
    tab.tap("#best label:nth-child(2) input")
    tab.tap("#second label:nth-child(1) input")
    tab.tap("#send")
    tab.wait_for_view("received")
    check(tab.taps == 3, "a ballot takes more than three taps")
    look_at(tab, "received-scales")
    check("0 of 9" in tab.js("document.querySelector('#answered').textContent"), "nobody says how many there are")
    tab.tap("#describe")
    tab.wait_for_view("scales")
    look_at(tab, "scales")
    heights = tab.js("[...document.querySelectorAll('.step')].map((e) => e.getBoundingClientRect().height)")
    check(len(heights) == 7 and min(heights) >= 56, f"seven large targets: {heights}")
    check(tab.js("document.querySelector('#look').textContent") == f"Look {codes[0]}", "not the lowest code first")

    def question():
        return tab.js("document.querySelector('#progress').textContent")

    def answer(step, then):
        tab.tap(f".step[value='{step}']")
        tab.wait(f"document.querySelector('#progress').textContent.startsWith('Question {then} ')", f"question {then}")

    answer(2, 2)
    check("<b>bold</b> or" in tab.js("document.querySelector('#words').textContent"), "the words are not text")
    look_at(tab, "scales-markup")
    check(tab.js("document.querySelectorAll('b, img').length") == 0, "words became elements")
    answer(7, 3)
    look_at(tab, "scales-long")
    tab.tap("#after")  # skipped
    check(question().startswith("Question 4 "), f"{question()}")
    check(tab.js("document.querySelector('#look').textContent") == f"Look {codes[1]}", "not the next code")
    answer(4, 5)
    # Back, changed, and taken back; a reload keeps what was answered.
    tab.tap("#before")
    look_at(tab, "scales-answered")
    check(tab.js("document.querySelector('.step[aria-pressed=true]').value") == "4", "the answer is gone")
    answer(5, 5)
    for _ in range(3):
        tab.tap("#before")
    tab.tap("#take-back")
    tab.wait("document.querySelector('#take-back').hidden", "the answer to be taken back")
    tab.leave("Page.reload")
    tab.wait_for_view("received")
    check("2 of 9" in tab.js("document.querySelector('#answered').textContent"), "answers are gone")
    tab.tap("#describe")
    tab.wait_for_view("scales")
    check(question().startswith("Question 2 "), f"not where the first is missing: {question()}")
    # The server is killed in between.
    server.kill()
    tab.tap(".step[value='1']")
    tab.wait("document.querySelector('#connection').textContent.includes('rying again')", "word of the lost connection")
    server.start()
    tab.wait("document.querySelector('#progress').textContent.startsWith('Question 3 ')", "the next question")
    tab.tap("#enough")
    tab.wait_for_view("received")
    # The ballot itself may still change, and keeps them.
    tab.tap("#change")
    tab.wait_for_view("voting")
    tab.tap("#best label:nth-child(3) input")
    tab.tap("#send")
    tab.wait_for_view("received")
    check("3 of 9" in tab.js("document.querySelector('#answered').textContent"), "answers went with the ballot")
    # Locked while it is answered.
    tab.tap("#describe")
    tab.wait_for_view("scales")
    server.operator("lock", round_)
    tab.wait_for_view("locked")
    kept = server.operator("ratings", round_)["1"]
    check(kept == {str(codes[0]): [2, 1, None], str(codes[1]): [5, None, None]}, f"kept {kept}")
    clean(tab, server.place["url"])


def new_invitation(server):
    deadline = time.monotonic() + 20
    while not (invitation := server.operator("invitation")):  # made within a quarter of a second
        check(time.monotonic() < deadline, "no invitation for the new audience")
        time.sleep(0.1)
    return invitation


def twelve_phones(browser, server):
    server.operator("session")
    invitation = new_invitation(server)
    tabs = [browser.phone() for _ in range(SEATS)]
    for tab in tabs:
        tab.go(f"{server.place['url']}join/{invitation['token']}")
    for tab in tabs:
        tab.wait_for_view("waiting")
        check(tab.js("location.pathname") == "/", "no clean address")
    seats = sorted(tab.js("document.querySelector('#seat').textContent") for tab in tabs)
    check(seats == sorted(f"Seat {k}" for k in range(1, SEATS + 1)), f"seats {seats}")
    round_ = server.operator("open", "a,b,c,d")
    for tab in tabs:
        tab.wait_for_view("voting")
    for tab in tabs:
        tab.tap("#best label:nth-child(2) input")
        tab.tap("#second label:nth-child(1) input")
    for tab in tabs:
        tab.tap("#send")
    for tab in tabs:
        tab.wait_for_view("received")
    receipts = {receipt(tab) for tab in tabs}
    check(len(receipts) == SEATS, "two have one receipt")
    server.operator("lock", round_)
    for tab in tabs:
        tab.wait_for_view("locked")
        clean(tab, server.place["url"])
    check(len(server.operator("ballots", round_)) == SEATS, "not twelve ballots")


program = find_browser()
with serving() as server:
    browser = Browser(program)
    try:
        begin = time.monotonic()
        one_phone(browser, server)
        two_groups(browser, server)
        scales(browser, server)
        twelve_phones(browser, server)
        print(f"page: contrast at least {Figures.contrast:.1f}, targets at least {Figures.target:.0f} px, three taps, "
              f"twelve phones; {time.monotonic() - begin:.1f} s")
    finally:
        browser.close()
