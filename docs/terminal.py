"""Draws docs/terminal.svg, the picture of the README: the output of two commands on a terminal.

python3 docs/terminal.py, in the repository's root, after cargo build --release. Standard library only.
"""
import html
import os
import re
import subprocess

COLOURS = {"31": "#ff7b72", "32": "#7ee787", "33": "#e3b341", "34": "#79c0ff", "35": "#d2a8ff", "36": "#76e3ea"}
BACKGROUND, FOREGROUND, DIM = "#0d1117", "#e6edf3", "#8b949e"
CHARACTER, LINE, MARGIN = 7.8, 17, 16
COMMANDS = [
    "identify examples/logs/paper_rig_pwm_noise.csv",
    "compare examples/logs/paper_rig_pwm_noise.csv --bounds rs=0:5,ld=0:50mH,lq=0:50mH,psi_f=0:1",
]


def output(command):
    environment = dict(os.environ, CLICOLOR_FORCE="1")
    environment.pop("NO_COLOR", None)
    run = subprocess.run(["target/release/fluxfit", *command.split()], capture_output=True, text=True, env=environment, check=True)
    return run.stdout.splitlines()


def spans(line, style):
    """One text element of a line: runs of characters of one style, each placed at its column. The style goes on in the next line."""
    column, parts = 0, []
    for piece in re.split(r"(\x1b\[[0-9;]*m)", line):
        if piece.startswith("\x1b"):
            for code in piece[2:-1].split(";"):
                if code in ("", "0"):
                    style.clear()
                elif code == "1":
                    style["font-weight"] = "bold"
                elif code == "2":
                    style["fill"] = DIM
                elif code in COLOURS:
                    style["fill"] = COLOURS[code]
        elif piece:
            if piece.strip():
                attributes = "".join(f' {name}="{value}"' for name, value in style.items())
                parts.append(f'<tspan x="{MARGIN + column * CHARACTER:.1f}" textLength="{len(piece) * CHARACTER:.1f}"{attributes}>{html.escape(piece)}</tspan>')
            column += len(piece)
    return "".join(parts)


def main():
    lines = []
    for command in COMMANDS:
        lines += [f"\x1b[2m$ fluxfit {command}\x1b[0m", *output(command), ""]
    plain = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in lines]
    width = MARGIN * 2 + max(map(len, plain)) * CHARACTER
    height = MARGIN * 2 + len(lines) * LINE
    style = {}
    body = "\n".join(f'<text y="{MARGIN + (row + 1) * LINE - 4}" xml:space="preserve">{spans(line, style)}</text>' for row, line in enumerate(lines) if line)
    svg = f'''<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.0f} {height:.0f}" role="img">
<title>fluxfit identify and fluxfit compare on a terminal</title>
<rect width="100%" height="100%" rx="8" fill="{BACKGROUND}"/>
<g font-family="ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace" font-size="13" fill="{FOREGROUND}">
{body}
</g>
</svg>
'''
    with open("docs/terminal.svg", "w", encoding="utf-8") as file:
        file.write(svg)


main()
