"""Ways to break the GLSL of a filter. They are textual and know no filter: a new one is broken as the others are.

Left out, because what they give is the same filter:
- numbers in encode(): it writes four channels, of which a store keeps as many as it has;
- the sign of a half before fract(): both signs lie a whole period apart;
- the bias of a receiver that is asked whether it lies beyond the map's depths: it is a texel's width from there or not;
- a share of nothing;
- a quotient by an axis, (1, 0) or (0, 1): it is the product, or undefined.
"""

import re
from dataclasses import dataclass

READS = r"\b(?:compare_nearest|compare_2x2|fetch_depth|gather_compare|gather_depth|fetch_map)\("
COMPARES = r"\b(?:compare_(?:nearest|2x2)|gather_compare)\("
FLOAT = r"(?<![\w.])\d+\.\d*(?:e-?\d+)?"


@dataclass(frozen=True)
class Mutant:
    """A body of GLSL with one thing broken."""

    operator: str
    line: int  # of the body, from 1
    before: str
    after: str
    body: str


@dataclass(frozen=True)
class Edit:
    """Puts a text where another stood."""

    start: int
    end: int
    text: str

    def apply(self, body):
        return body[: self.start] + self.text + body[self.end :]


def blank_comments(body):
    """Gives the body with comments as spaces: places stay."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m.group()), body, flags=re.S)


def find_close(code, opened):
    """Gives the place of the parenthesis that closes the one at `opened`."""
    depth = 0
    for i in range(opened, len(code)):
        depth += {"(": 1, ")": -1}.get(code[i], 0)
        if depth == 0:
            return i
    raise ValueError("unbalanced parentheses in " + code[opened : opened + 40])


def split_arguments(code, opened):
    """Gives where the arguments of a call begin and end."""
    spans, depth, start, close = [], 0, opened + 1, find_close(code, opened)
    for i in range(opened + 1, close):
        depth += {"(": 1, ")": -1}.get(code[i], 0)
        if code[i] == "," and depth == 0:
            spans.append((start, i))
            start = i + 1
    return spans + [(start, close)]


def find_spans(code, call):
    """Gives the spans between the parentheses of every call that matches."""
    return [(m.end(), find_close(code, m.end() - 1)) for m in re.finditer(call, code)]


def is_within(place, spans):
    return any(start <= place < end for start, end in spans)


def find_encode(code):
    """Gives the span of the body of encode(), or nothing."""
    found = re.search(r"\bencode\s*\([^)]*\)\s*\{", code)
    if not found:
        return []
    depth = 1
    for i in range(found.end(), len(code)):
        depth += {"{": 1, "}": -1}.get(code[i], 0)
        if depth == 0:
            return [(found.start(), i)]
    return [(found.start(), len(code))]


def move_taps(code):
    """Reads a texel further, along u and v in turn."""
    for i, m in enumerate(re.finditer(READS, code)):
        start, end = split_arguments(code, m.end() - 1)[1]
        yield Edit(start, end, f"{code[start:end]} + vec2({('1.0, 0.0', '0.0, 1.0')[i % 2]})")


def invert_compares(code):
    """Takes lit for blocked in one read."""
    for m in re.finditer(COMPARES, code):
        close = find_close(code, m.end() - 1)
        yield Edit(m.start(), close + 1, f"(1.0 - {code[m.start():close + 1]})")


def negate_conditions(code):
    """Turns a condition into its opposite."""
    opposite = {"<=": ">", ">=": "<", "<": ">=", ">": "<=", "==": "!=", "!=": "=="}
    for m in re.finditer(r"(?<= )(<=|>=|==|!=|<|>)(?= )", code):
        yield Edit(m.start(), m.end(), opposite[m.group()])


def drop_bias(code):
    """Compares the receiver's own depth."""
    for m in re.finditer(r"\br\.depth\b(?! > 1\.0\b)", code):
        yield Edit(m.start(), m.end(), "r.depth_unbiased")


def scale_results(code):
    """Makes what is returned 3 % less; of whole numbers it halves them."""
    halves = {"int": " / 2", "uint": " / 2u", "uvec4": " / 2u"}
    types = [(f.start(), f.group(1)) for f in re.finditer(r"^(\w+) \w+\([^)]*\)\s*{", code, re.MULTILINE)]
    for m in re.finditer(r"\breturn\s+(?!0\.0;)([^;]+);", code):
        kind = next((each for start, each in reversed(types) if start < m.start()), "float")
        scaled = f"({m.group(1)}){halves[kind]}" if kind in halves else f"0.97 * ({m.group(1)})"
        yield Edit(m.start(1), m.end(1), scaled)


def change_numbers(code):
    """Makes numbers half as much again; none becomes a quarter."""
    encode = find_encode(code)
    for m in re.finditer(FLOAT, code):
        if not is_within(m.start(), encode):
            yield Edit(m.start(), m.end(), "0.25" if float(m.group()) == 0.0 else f"({m.group()} * 1.5)")


def swap_signs(code):
    """Swaps plus and minus, between operands, before assignments and before numbers."""
    periodic = find_spans(code, r"\bfract\(")
    for m in re.finditer(r"(?<= )([+-])(=?)(?= )", code):
        if is_within(m.start(), periodic) and re.match(r" \d*\.5\b", code[m.end() :]):
            continue
        yield Edit(m.start(1), m.end(1), "-" if m.group(1) == "+" else "+")
    for m in re.finditer(r"(?<![\w)+-])-(?=[\d\w(])", code):
        yield Edit(m.start(), m.end(), "")


def swap_factors(code):
    """Swaps multiplication and division."""
    for m in re.finditer(r"(?<= )[*/](?= (?!p\.direction\b))", code):
        yield Edit(m.start(), m.end(), "/" if m.group() == "*" else "*")


def swap_names(code):
    """Takes one axis for the other, the sine for the cosine, the less for the more."""
    other = {"cos": "sin", "sin": "cos", "min": "max", "max": "min", "x": "y", "y": "x"}
    for m in re.finditer(r"\b(cos|sin|min|max)(?=\()|(?<=\.)[xy]\b", code):
        yield Edit(m.start(), m.end(), other[m.group()])


OPERATORS = {
    "tap offset": move_taps,
    "comparison": invert_compares,
    "condition": negate_conditions,
    "missing bias": drop_bias,
    "weight": scale_results,
    "number": change_numbers,
    "sign": swap_signs,
    "factor": swap_factors,
    "name": swap_names,
}


def shorten(code, start, end, around=14):
    """Gives what stands at a place and a little of what stands beside it, in whole words, on one line."""
    first = max(code.rfind("\n", 0, start) + 1, start - around)
    line_end = code.find("\n", end)
    last = min(len(code) if line_end < 0 else line_end, end + around)
    while first < start and re.match(r"[\w.]{2}", code[first - 1 : first + 1]):
        first += 1
    while last > end and re.match(r"[\w.]{2}", code[last - 1 : last + 1]):
        last -= 1
    return " ".join(code[first:last].split())


def make_mutants(body):
    """Gives every mutant of a filter's GLSL, in the order of OPERATORS."""
    code, mutants = blank_comments(body), []
    for name, operator in OPERATORS.items():
        for edit in operator(code):
            line = code.count("\n", 0, edit.start) + 1
            before = shorten(code, edit.start, edit.end)
            after = shorten(edit.apply(code), edit.start, edit.start + len(edit.text))
            mutants.append(Mutant(name, line, before, after, edit.apply(body)))
    return mutants
