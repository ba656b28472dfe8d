"""One contact without a bearing: from a TOML file or an input file of CONTACT to tractions and forces."""

from __future__ import annotations

from pathlib import Path

from separatrix.contact_file.question import ContactQuestion

INP = ".inp"


def read_contact(path: str | Path) -> ContactQuestion:
    """Read the question of a contact file; an ending .inp is an input file of CONTACT, another one TOML.

    Raises
    ------
    InputError
        Everything that is wrong with a TOML file, a line each; the first fault of an input file of CONTACT.
    """
    if Path(path).suffix.casefold() == INP:
        from separatrix.contact_file.contact_inp import read_inp

        return read_inp(Path(path))
    from separatrix.contact_file.toml import read_contact_toml

    return read_contact_toml(Path(path))
