"""The search for the cheapest rungs: downhill from several starts, one rung of one term in one pass at a time.

Costs add up over passes, and pictures have to be looked at. A state is given up for a cheaper one only when the picture
of all passes together stays within the budget, and a descent ends where no cheaper rung of any term in any pass does:
each of them was drawn, from that very state.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

#: (pass, macro) -> rung
State = Mapping[tuple[str, str], str]


@dataclass(frozen=True)
class Step:
    """From a state to a cheaper one: another rung of one term in one pass. ``saves`` is in the costs' unit."""

    pass_name: str
    macro: str
    rung: str
    saves: float

    def of(self, state: State) -> State:
        """The state after it."""
        return {**state, (self.pass_name, self.macro): self.rung}


@dataclass(frozen=True)
class Found:
    """Where the cheapest descent ended. ``refused`` are all steps down from there: none is within the budget."""

    state: State
    cost: float
    refused: tuple[Step, ...]


class Search:
    """The states of a project and what is known of them."""

    def __init__(
        self,
        rungs: Mapping[tuple[str, str], Sequence[str]],
        costs: Callable[[Sequence[tuple[str, State]]], Sequence[float]],
        fits: Callable[[State], bool],
    ):
        """``rungs`` of each (pass, macro); ``costs`` of passes, each in a state; whether the picture of a state
        ``fits`` the budget, which is asked once a state."""
        self._rungs, self._costs, self._fits = rungs, costs, fits
        self._passes = list(dict.fromkeys(name for name, _ in rungs))
        self._known: dict[tuple, bool] = {}
        #: steps that did not fit from some state: they are tried last elsewhere
        self._unlikely: set[tuple[str, str, str]] = set()

    def cheapest(self, starts: Iterable[State]) -> Found | None:
        """The cheapest of the descents from those starts that fit; of equal ones the first. None where none does."""
        ends = [self._descend(start) for start in starts if self.fits(start)]
        return min(ends, key=lambda end: end.cost, default=None)

    def fits(self, state: State) -> bool:
        """Whether the picture of a state is within the budget."""
        key = tuple(sorted(state.items()))
        if key not in self._known:
            self._known[key] = self._fits(state)
        return self._known[key]

    def cost(self, state: State) -> float:
        """Of all passes."""
        return sum(self._costs([(name, state) for name in self._passes]))

    def steps(self, state: State) -> list[Step]:
        """All cheaper rungs of a term in a pass, those that save most first."""
        now = dict(zip(self._passes, self._costs([(name, state) for name in self._passes]), strict=True))
        others = list(self._others(state))
        costs = self._costs([(name, {**state, (name, macro): rung}) for name, macro, rung in others])
        found = [Step(*o, saves=now[o[0]] - cost) for o, cost in zip(others, costs, strict=True) if cost < now[o[0]]]
        return sorted(found, key=lambda s: -s.saves)

    def _others(self, state: State) -> Iterator[tuple[str, str, str]]:
        for (name, macro), rungs in self._rungs.items():
            yield from ((name, macro, rung) for rung in rungs if rung != state[name, macro])

    def _descend(self, state: State) -> Found:
        while True:
            steps = self.steps(state)
            likely_first = sorted(steps, key=lambda s: (s.pass_name, s.macro, s.rung) in self._unlikely)
            taken = next((step for step in likely_first if self._try(step, state)), None)
            if taken is None:
                return Found(state, self.cost(state), tuple(steps))
            state = taken.of(state)

    def _try(self, step: Step, state: State) -> bool:
        fits = self.fits(step.of(state))
        if not fits:
            self._unlikely.add((step.pass_name, step.macro, step.rung))
        return fits
