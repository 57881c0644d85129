"""Where a cluster is, and the files that prove who one is there."""

import re
import ssl
from dataclasses import dataclass
from pathlib import Path

from roadbed_cluster.errors import UsageError

_MOST_PORT = 65535


@dataclass(frozen=True)
class ClusterOptions:
    """Where the cluster is, and who may talk to it."""

    scheduler: str | None = None  #: address; None: a cluster of its own
    workers: int | None = None  #: of a cluster of its own; None: one per core
    tls_ca: Path | None = None
    tls_cert: Path | None = None
    tls_key: Path | None = None

    @property
    def is_encrypted(self) -> bool:
        """Whether the scheduler's address asks for TLS."""
        return self.scheduler is not None and self.scheduler.startswith("tls://")

    def check(self) -> None:
        """Check that the options fit each other.

        Raises:
            UsageError: if they do not, the address is none, or a file of TLS is not there
                or not what it should be.
        """
        if self.scheduler is not None:
            _check_address(self.scheduler)
        files = {
            "--tls-ca": self.tls_ca,
            "--tls-cert": self.tls_cert,
            "--tls-key": self.tls_key,
        }
        if self.workers is not None and self.scheduler is not None:
            raise UsageError("--workers is for a cluster of its own, not with --scheduler")
        for name, file in files.items():
            if self.is_encrypted and file is None:
                raise UsageError(f"{self.scheduler} needs {name} FILE")
            if not self.is_encrypted and file is not None:
                raise UsageError(f"{name} needs --scheduler tls://HOST:PORT")
            if file is not None and not file.is_file():
                raise UsageError(f"{name}: {file}: no such file")
        if self.is_encrypted:
            self._check_certificates()

    def _check_certificates(self) -> None:
        assert self.tls_ca is not None and self.tls_cert is not None
        try:
            context = ssl.create_default_context(cafile=self.tls_ca)
        except ssl.SSLError as error:
            raise UsageError(f"--tls-ca: {self.tls_ca}: is no certificate (.pem)") from error
        try:
            context.load_cert_chain(self.tls_cert, self.tls_key, password="")
        except (ssl.SSLError, ValueError) as error:
            raise UsageError(
                f"--tls-cert, --tls-key: {self.tls_cert} and {self.tls_key} are no certificate and "
                "its key (.pem)"
            ) from error


def _check_address(address: str) -> None:
    found = re.fullmatch(r"((tcp|tls)://)?([^\s:/]+|\[[0-9a-fA-F:.]+\]):([0-9]+)", address)
    if found is None or not 0 < int(found[4]) <= _MOST_PORT:
        raise UsageError(
            f"--scheduler: {address!r} is no address such as tcp://10.0.0.1:8786 or "
            "tls://10.0.0.1:8786"
        )
