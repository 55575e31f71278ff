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
    off: float
    refused: tuple[Step, ...]


class Search:
    """The states of a project and what is known of them."""

    def __init__(
        self,
        rungs: Mapping[tuple[str, str], Sequence[str]],
        costs: Callable[[Sequence[tuple[str, State]]], Sequence[float]],
        off: Callable[[State], float | None],
        reference: State,
    ):
        """``rungs`` of each (pass, macro); ``costs`` of passes, each in a state; how far the picture of a state is
        ``off`` that of the ``reference``, None beyond the budget, which is asked once a state."""
        self._rungs, self._costs, self._off, self._reference = rungs, costs, off, reference
        self._passes = list(dict.fromkeys(name for name, _ in rungs))
        self._known: dict[tuple, float | None] = {}
        #: steps that did not fit from some state: they are tried last elsewhere
        self._unlikely: set[tuple[str, str, str]] = set()

    def cheapest(self, starts: Iterable[State]) -> Found | None:
        """The cheapest of the descents from those starts that fit; of equal ones the nearest to the reference. None
        where none does."""
        ends = [self._descend(start) for start in starts if self.off(start) is not None]
        return min(ends, key=lambda end: (end.cost, end.off), default=None)

    def off(self, state: State) -> float | None:
        """How far the picture of a state is off, None beyond the budget."""
        key = tuple(sorted(state.items()))
        if key not in self._known:
            self._known[key] = self._off(state)
        return self._known[key]

    def cost(self, state: State) -> float:
        """Of all passes."""
        return sum(self._costs([(name, state) for name in self._passes]))

    def steps(self, state: State) -> list[Step]:
        """All other rungs of a term in a pass that cost no more, those that save most first."""
        others = list(self._others(state))
        asked = [(name, state) for name in self._passes]
        costs = self._costs(asked + [(name, {**state, (name, macro): rung}) for name, macro, rung in others])
        now, costs = dict(zip(self._passes, costs, strict=False)), costs[len(asked) :]
        found = [Step(*o, saves=now[o[0]] - cost) for o, cost in zip(others, costs, strict=True) if cost <= now[o[0]]]
        return sorted(found, key=lambda s: -s.saves)

    def _others(self, state: State) -> Iterator[tuple[str, str, str]]:
        for (name, macro), rungs in self._rungs.items():
            yield from ((name, macro, rung) for rung in rungs if rung != state[name, macro])

    def _descend(self, state: State) -> Found:
        """Downhill, and on a level nearer to the reference, until there is neither."""
        while True:
            steps = self.steps(state)
            down = [step for step in steps if step.saves > 0]
            likely_first = sorted(down, key=lambda s: (s.pass_name, s.macro, s.rung) in self._unlikely)
            following = next((s.of(state) for s in likely_first if self._fits(s, state)), None)
            if following is None:
                following = self._nearer(state, [step for step in steps if step.saves == 0])
            if following is None:
                return Found(state, self.cost(state), self.off(state), tuple(down))
            state = following

    def _fits(self, step: Step, state: State) -> bool:
        fits = self.off(step.of(state)) is not None
        if not fits:
            self._unlikely.add((step.pass_name, step.macro, step.rung))
        return fits

    def _nearer(self, state: State, level: Iterable[Step]) -> State | None:
        """A state that costs the same and is less off, by another rung of a term that is not the reference's."""
        for step in level:
            place = step.pass_name, step.macro
            if state[place] != self._reference[place]:
                off = self.off(step.of(state))
                if off is not None and off < self.off(state):
                    return step.of(state)
        return None
