import subprocess
import sys

COUNT = """
import sys
from umform.cli.drawing import without_help_texts
if sys.argv[1] == "command":
    without_help_texts()
import matplotlib.artist as artist
counted, text_of = [], artist.kwdoc
artist.kwdoc = lambda artist: (counted.append(text_of(artist)), counted[-1])[1]
from umform.plotting import Figure, save
figure = Figure(figsize=(2, 1))
figure.add_subplot().plot([0, 1], [1, 0], label="line")
save(figure, sys.argv[2])
print(sum(map(bool, counted)))
"""


def help_texts(kind, picture):
    """Help texts that matplotlib writes until a picture is saved, and the picture."""
    run = subprocess.run([sys.executable, "-c", COUNT, kind, str(picture)], capture_output=True, text=True, check=True)
    return int(run.stdout), picture.read_bytes()


def test_no_command_loads_matplotlib_before_it_draws():
    code = "import sys; from umform.cli.drawing import without_help_texts; without_help_texts(); print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "matplotlib" not in run.stdout


def test_every_command_does_without_help_texts():
    code = "import sys; from umform.cli import main; sys.argv[1:] = ['--version']\n"
    code += "try: main()\nfinally: print(*(getattr(finder, 'name', '') for finder in sys.meta_path))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert {"matplotlib.artist", "typer.rich_utils"} <= set(run.stdout.split())


def test_a_command_draws_the_same_without_help_texts(tmp_path):
    few, quick = help_texts("command", tmp_path / "quick.png")
    many, usual = help_texts("library", tmp_path / "usual.png")
    assert few == 0 < many
    assert quick == usual
