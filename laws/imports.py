"""Finds files of a crate that import each other in a circle.

A file imports what its `use` lines and the paths in its code name; a re-export (`pub use`) counts as the file that it comes from, and
a parent that only declares or re-exports its children imports none of them. Tests are not checked.
"""

from collections import defaultdict

from modules import load, resolve


def imports(root_file):
    """For each file of the crate: the files that it imports, each with the line and the path that import it."""
    root = load(root_file)
    edges = defaultdict(dict)

    def visit(module):
        for path, line, name in module.mentions:
            file, target = resolve(module, path, root)
            # `use module;` alone imports nothing: the code then names what it uses as `module::thing`, which is found there.
            if file and file != module.file and not (name and name != "*" and target):
                edges[module.file].setdefault(file, f"{module.file}:{line}: {'::'.join(path)}")
        for child in module.children.values():
            visit(child)

    visit(root)
    return edges


def circles(edges):
    """The strongly connected components of more than one file, by Tarjan's algorithm (1972)."""
    index, low, stack, found = {}, {}, [], []

    def visit(file):
        index[file] = low[file] = len(index)
        stack.append(file)
        for other in edges.get(file, ()):
            if other not in index:
                visit(other)
                low[file] = min(low[file], low[other])
            elif other in stack:
                low[file] = min(low[file], index[other])
        if low[file] == index[file]:
            component = stack[stack.index(file) :]
            del stack[stack.index(file) :]
            if len(component) > 1:
                found.append(component)

    for file in list(edges):
        if file not in index:
            visit(file)
    return found


def violations(root_files):
    """One line for each circle, and one for each import in it."""
    for root_file in root_files:
        edges = imports(root_file)
        for component in circles(edges):
            inner = [edges[file][other] for file in component for other in edges[file] if other in component]
            yield f"{len(component)} files import each other in a circle:"
            yield from (f"    {place}" for place in sorted(inner))
