"""One run of the program: what lies there, what it is asked."""
import dataclasses
import typing

import files


@dataclasses.dataclass
class Case:
    name: str
    arguments: list
    # Changes the good files in the first folder; the second holds it, canary/ and out/.
    change: typing.Callable = lambda inputs, place: None
    quick: bool = False
    cpu_s: float = 10
    exit_codes: tuple = ()
    says: str = ""
    may_change: tuple = ()

    def make(self, inputs, place):
        place.mkdir(parents=True)
        files.good_folder(inputs)
        self.change(inputs, place)
