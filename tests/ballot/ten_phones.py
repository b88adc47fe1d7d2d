#!/usr/bin/env python3
"""Phones of evaluators in Chromium: each joins, waits until it may vote, and votes with three taps.

    tests/ballot/ten_phones.py JOIN_URL COUNT SEED

Says "joined N" when all are in, "voted N" with their taps when all have a receipt. Half of the first choices are one
code, as where people agree; the rest are drawn by the seed."""
import random
import sys
import time

from browser import Browser, find_browser
from server import check

UNTIL_VOTING_S = 300


def vote(tab, favourite, numbers):
    codes = tab.js("[...document.querySelectorAll('#best input')].map((e) => Number(e.value))")
    best = codes[favourite] if numbers.random() < 0.5 else numbers.choice(codes)
    second = numbers.choice([code for code in codes if code != best])
    tab.taps = 0
    tab.tap(f"#best input[value='{best}']")
    tab.tap(f"#second input[value='{second}']")
    tab.tap("#send")
    tab.wait_for_view("received")
    check(tab.taps == 3, f"{tab.taps} taps")


def main():
    url, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    numbers = random.Random(seed)
    browser = Browser(find_browser())
    try:
        phones = [browser.phone() for _ in range(count)]
        longest = 0.0
        for phone in phones:
            begin = time.monotonic()
            phone.go(url)
            phone.wait_for_view("waiting")
            longest = max(longest, time.monotonic() - begin)
        print(f"joined {count}, the slowest in {longest:.1f} s", flush=True)
        for phone in phones:
            phone.wait("[...document.querySelectorAll('section')].some(s => !s.hidden && s.dataset.view === 'voting')",
                       "the vote", UNTIL_VOTING_S)
        for phone in phones:
            vote(phone, 1, numbers)
        print(f"voted {count}, three taps each", flush=True)
    finally:
        browser.close()


if __name__ == "__main__":
    main()
