#!/usr/bin/env python3
"""Makes docs/api.md, the reference of the library, from include/toile and from the docstrings of python/toile.

Usage: api_reference.py [--check] [SOURCE_ROOT]      --check writes nothing; exit 1 when the file is not what it would be.

Nothing is said twice: a header's comments and declarations are its reference, and so are a docstring and its signature.
"""
import ast
import pathlib
import re
import sys

headers = ["version", "types", "error", "fabric", "cloth", "body", "simulation", "verify", "run"]
head = """# Reference

Made by `tools/api_reference.py` (`make api-reference`) from `include/toile` and `python/toile`; do not edit. To begin with: [C++](howto/cpp.md),
[Python](howto/python.md) in ten minutes.

"""


def of_header(path):
    """(what the header is, its declarations as they stand)"""
    text = path.read_text()
    title = re.match(rf"// toile/{path.name}: (.*)", text).group(1)
    title = re.sub(r" {3,}(.*)", r" (\1)", title)  # the source, at the right
    body = text.split("#pragma once", 1)[1]
    above = [line[2:].strip() for line in text.split("#pragma once", 1)[0].splitlines()[1:]]
    body = re.sub(r"^#include .*\n", "", body, flags=re.MULTILINE)
    body = body.replace("TOILE_EXPORT ", "").replace("TOILE_HIDDEN ", "")
    body = re.sub(r"\n private:\n.*?(?=\n};)", "", body, flags=re.DOTALL)
    body = re.sub(r"^namespace toile \{\n|^\}  // namespace toile\n", "", body, flags=re.MULTILINE)
    return title, "\n".join(above).strip(), re.sub(r"\n+\n(?=\n|\};)", "\n", body).strip()


def signature(node):
    text = ast.unparse(node.args)
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"{node.name}({text}){returns}"


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def documented(node, indent=""):
    """Lines of a class or a function: its signature, its docstring."""
    lines = []
    if isinstance(node, ast.ClassDef):
        bases = [ast.unparse(b) for b in node.bases if ast.unparse(b) != "Made"]
        lines.append(f"class {node.name}{'(' + ', '.join(bases) + ')' if bases else ''}")
    elif is_property(node):
        lines.append(indent + node.name + (f": {ast.unparse(node.returns)}" if node.returns else ""))
    else:
        lines.append(indent + signature(node))
    text = ast.get_docstring(node)
    if text:
        lines += [(indent + "    " + line).rstrip() for line in text.splitlines()]
    if isinstance(node, ast.ClassDef):
        for member in node.body:
            if isinstance(member, ast.FunctionDef) and (not member.name.startswith("_") or member.name == "__init__"):
                lines += ["", *documented(member, "    ")]
    return lines


def python_names(folder):
    """Of __all__, those that are written in Python: {name: node}; and the others, which are C++'s."""
    package = ast.parse((folder / "__init__.py").read_text())
    names = next(ast.literal_eval(n.value) for n in package.body
                 if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
    found = {}
    for path in sorted(folder.glob("_*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in names:
                found[node.name] = node
    return found, [name for name in names if name not in found and name != "__version__"]


def reference(root):
    text = head + "## C++\n"
    known = {path.stem for path in (root / "include/toile").glob("*.hpp")} - {"export"}
    if known != set(headers):
        sys.exit(f"tools/api_reference.py: headers are {sorted(known)}, expected {sorted(headers)}")
    for name in headers:
        title, above, body = of_header(root / f"include/toile/{name}.hpp")
        about = "\n".join("// " + line if line else "//" for line in above.splitlines()) + "\n\n" if above else ""
        text += f"\n### toile/{name}.hpp\n\n{title[0].upper() + title[1:]}\n\n```c++\n{about}{body}\n```\n"
    found, others = python_names(root / "python/toile")
    text += "\n## Python\n\nThe same words in the same order. As in C++, with fields of the same names: " + ", ".join(f"`{n}`" for n in others) + ".\n"
    for name in sorted(found):
        text += f"\n### toile.{name}\n\n```text\n" + "\n".join(documented(found[name])) + "\n```\n"
    return text


def main():
    words = [word for word in sys.argv[1:] if word != "--check"]
    root = pathlib.Path(words[0] if words else pathlib.Path(__file__).resolve().parent.parent)
    page, made = root / "docs/api.md", reference(root)
    if "--check" not in sys.argv:
        page.write_text(made)
    elif not page.is_file() or page.read_text() != made:
        print("docs/api.md is not what include/toile and python/toile say: make api-reference")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
