"""The tutorial runs from its folder, and shows what it speaks of."""

import nbformat
from nbclient import NotebookClient
from places import DATA


def test_the_tutorial_runs_and_shows_pictures() -> None:
    notebook = nbformat.read(DATA / "tutorial.ipynb", as_version=4)  # type: ignore[no-untyped-call]
    NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(DATA)}}
    ).execute()
    outputs = [
        output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
    ]
    pictures = [output for output in outputs if "image/svg+xml" in output.get("data", {})]
    assert len(pictures) >= 6  # map, route, reach, plan, drive, audit
    assert any("image/png" in output.get("data", {}) for output in outputs)
