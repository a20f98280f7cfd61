"""What may be altered in a module, and how a running process is made to run the altered code.

A mutant differs in one place of the body of one function: a comparison, an operator, a number, a flag, a branch, or a
call that is left out. Only the code of that function is exchanged, in memory: no file is written.
"""

import ast
import gc
import hashlib
import importlib
import importlib.util
from collections import Counter
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from types import CodeType, FunctionType

COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
"""What stands in place of a comparison: the bound moved by a hair, and the other direction."""
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
}


@dataclass(frozen=True, slots=True)
class Mutant:
    """One alteration.

    module: as it is imported. function, line: where, the function by its qualified name. number: of the mutant in its
    module. before, after: the altered expression or statement. key: the same as long as the function is.
    """

    module: str
    function: str
    line: int
    number: int
    before: str
    after: str
    key: str


@dataclass(slots=True)
class _Place:
    """A node of a function, and one of its alterations: of a comparison of several parts also which part."""

    function: str
    node: ast.AST
    change: str
    part: int = 0


def source_of(module: str) -> str:
    """The text of a module."""
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        raise ValueError(f"{module}: no such module")
    return Path(spec.origin).read_text(encoding="utf-8")


def mutants_of(module: str, source: str) -> Iterator[Mutant]:
    """All mutants of a module, in the order of its text."""
    seen: Counter[str] = Counter()
    for number, place in enumerate(_places(ast.parse(source))):
        line, before = getattr(place.node, "lineno", 0), _shown(place.node)
        altered = replace(place, node=deepcopy(place.node))
        _alter(altered)
        after = "pass" if place.change == "call" else _shown(altered.node)
        identity = f"{module} {place.function} {before} {after}"
        seen[identity] += 1
        key = hashlib.sha256(f"{identity} {seen[identity]}".encode()).hexdigest()[:16]
        yield Mutant(module, place.function, line, number, before, after, key)


def put_in(mutant: Mutant, source: str) -> int:
    """Exchange the code of a mutant's function in this process; how many function objects had it."""
    tree = ast.parse(source)
    place = list(_places(tree))[mutant.number]
    _alter(place)
    whole = compile(ast.fix_missing_locations(tree), mutant.module, "exec")
    code = next(code for code in _codes(whole) if code.co_qualname == mutant.function)
    importlib.import_module(mutant.module)
    functions = [
        thing
        for thing in gc.get_objects()
        if type(thing) is FunctionType
        and thing.__module__ == mutant.module
        and thing.__code__.co_qualname == mutant.function
        and thing.__code__.co_firstlineno == code.co_firstlineno
    ]
    for function in functions:
        function.__code__ = code
    return len(functions)


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _places(tree: ast.Module) -> Iterator[_Place]:
    for name, function in _functions(tree, ""):
        for statement in function.body:
            for node in _walk(statement):
                yield from (_Place(name, node, *change) for change in _changes(node))


def _functions(parent: ast.AST, prefix: str) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Functions and methods by qualified name; functions within functions belong to the outer one."""
    for child in ast.iter_child_nodes(parent):
        if isinstance(child, ast.FunctionDef):
            yield prefix + child.name, child
        elif isinstance(child, ast.ClassDef):
            yield from _functions(child, f"{prefix}{child.name}.")


def _walk(node: ast.AST) -> Iterator[ast.AST]:
    """A node and all below it but annotations, formats and whether `zip` is strict, in the order of the text."""
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "format_spec"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _walk(child)


def _changes(node: ast.AST) -> Iterator[tuple[str, int]]:
    """The alterations of a node."""
    match node:
        case ast.Compare():
            for part, operator in enumerate(node.ops):
                yield from ((change.__name__, part) for change in COMPARISONS.get(type(operator), ()))
        case ast.BinOp() | ast.AugAssign() if type(node.op) in OPERATORS:
            yield "operator", 0
        case ast.BoolOp():
            yield "junction", 0
        case ast.UnaryOp(op=ast.Not()):
            yield "negation", 0
        case ast.Constant(value=bool() | int() | float()):
            yield "constant", 0
        case ast.If() | ast.IfExp() | ast.While():
            # A comparison or a negation as the whole test has this alteration of its own.
            if isinstance(node.test, ast.Name | ast.Attribute | ast.Call | ast.NamedExpr | ast.BoolOp):
                yield "branch", 0
        case ast.Expr(value=ast.Call()):
            yield "call", 0


def _alter(place: _Place) -> None:
    match place.node:
        case ast.Compare() as node:
            node.ops[place.part] = getattr(ast, place.change)()
        case ast.BinOp() | ast.AugAssign() as node:
            node.op = OPERATORS[type(node.op)]()
        case ast.BoolOp() as node:
            node.op = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        case ast.UnaryOp() as node:
            node.operand = ast.UnaryOp(ast.Not(), node.operand)
        case ast.Constant(value=bool(flag)) as node:
            node.value = not flag
        case ast.Constant(value=int(value) | float(value)) as node:
            node.value = value + 1
        case ast.If() | ast.IfExp() | ast.While() as node:
            node.test = ast.UnaryOp(ast.Not(), node.test)
        case ast.Expr() as node:
            node.value = ast.Constant(None)


def _shown(node: ast.AST) -> str:
    """An expression or a statement in a line; of a branch its test."""
    if isinstance(node, ast.If | ast.While):
        node = node.test
    return " ".join(ast.unparse(node).split())
