#!/usr/bin/env python3
"""Kills the server, and the operator's program, at random moments while twelve seats vote: no confirmed vote is
lost, none counts twice.

    tests/ballot/killed.py build/release/bin/livery-ballots build/release/bin/ballot_operator
    LIVERY_BALLOT_KILLS=100 tests/ballot/killed.py ...     rounds (default 6; 100 with LIVERY_THOROUGH),
                                                            two kills each"""
import http.client
import os
import random
import subprocess
import threading
import time

from server import Phone, at_once, check, seed_of, serving

SEATS = 12
chance = random.Random(seed_of(20261125))
rounds = int(os.environ.get("LIVERY_BALLOT_KILLS", "100" if "LIVERY_THOROUGH" in os.environ else "6"))


def vote_until(phone, round_, codes, over, sent, confirmed):
    """Changes its mind until `over`, then sends until the last is confirmed."""
    own = random.Random(phone.seat)
    choice = None
    while True:
        if choice is None:
            if over.is_set() and confirmed[phone.seat]:
                return
            choice = tuple(own.sample(codes, 2))
            sent[phone.seat] = choice
        try:
            status, _, answer = phone.vote(round_, *choice)
        except (OSError, http.client.HTTPException):
            time.sleep(0.02)
            continue
        check(status == 200, f"vote: {status} {answer}")
        check((answer["ballot"]["best"], answer["ballot"]["second"]) == choice, "another vote confirmed")
        confirmed[phone.seat].append((*choice, answer["receipt"]))
        choice = None


def kill_lock(server, round_):
    """Locks the round by a program that is killed at some moment, as often as it takes."""
    tries = 0
    while not server.operator("show")["rounds"][-1]["closed"]:
        operator = subprocess.Popen([server.operator_program, str(server.file), "lock", str(round_)],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        tries += 1
        time.sleep(chance.uniform(0, 0.004 * tries))
        operator.kill()
        operator.wait()
    return tries


with serving() as server:
    token = server.operator("invitation")["token"]
    phones = [Phone(server) for _ in range(SEATS)]
    for phone in phones:
        phone.join(token)
    votes = kills = operator_kills = 0
    for number in range(rounds):
        round_ = server.operator("open", "a,b,c,d")
        codes = server.operator("show")["rounds"][-1]["codes"]
        over, sent, confirmed = threading.Event(), {}, {phone.seat: [] for phone in phones}

        def disturb():
            global kills
            for _ in range(2):
                time.sleep(chance.uniform(0, 0.2))
                server.kill()
                kills += 1
                server.start()
            over.set()

        at_once([disturb, *(lambda phone=phone: vote_until(phone, round_, codes, over, sent, confirmed)
                            for phone in phones)])
        operator_kills += kill_lock(server, round_)
        kept = {int(seat): (codes[best], codes[second], receipt)
                for seat, (best, second, receipt) in server.operator("ballots", round_).items()}
        last = {seat: told[-1] for seat, told in confirmed.items()}
        check(kept == last, f"round {round_}: kept {kept}, confirmed {last}")
        votes += sum(map(len, confirmed.values()))
    check(server.operator("show")["seats"] == SEATS, "seats were lost or made")
    print(f"killed: {rounds} rounds, {kills} kills of the server, {operator_kills} of the operator's program, "
          f"{votes} votes confirmed: 0 lost, 0 double")
    check(server.stop() == 0, "it did not end well")
