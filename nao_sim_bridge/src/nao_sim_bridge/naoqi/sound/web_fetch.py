"""The fetching process: `python -m nao_sim_bridge.naoqi.sound.web_fetch FD MEMORY`. One address, then it ends.

In a process of its own, because names, TLS and headers take as long as a server likes and cannot be broken off in a
thread; who started it ends it. It answers ("fetch", (address, path of the file to fill, StreamSizes, whether private
addresses are allowed)) with ("fetched", bytes) or ("error", text). It ends when its time is over or its pipe is closed.
"""

from __future__ import annotations

import http.client
import ipaddress
import math
import resource
import signal
import socket
import ssl
import sys
import urllib.parse
from typing import BinaryIO, Callable, Iterable

from nao_sim_bridge.base.child_process import limit_memory, pipe_to_parent
from nao_sim_bridge.base.sizes import StreamSizes

CHUNK = 64 * 1024
REDIRECTS = (301, 302, 303, 307, 308)
# Prefixes of IPv6 that stand for an address of IPv4 in their last 32 bits, beside those that `ipaddress` knows.
TRANSLATED = (
    ipaddress.ip_network("64:ff9b::/96"),
    ipaddress.ip_network("64:ff9b:1::/48"),
    ipaddress.ip_network("::/96"),
)
Allowed = Callable[[str], bool]
Resolve = Callable[[str, int], Iterable[str]]


class Refused(ValueError):
    """An address, or what is there, that is not fetched; the text says why."""


def is_public(address: str) -> bool:
    """Whether a numeric address belongs to the public Internet: no loopback, no private network, no multicast."""
    one = ipaddress.ip_address(address.split("%", 1)[0])
    if isinstance(one, ipaddress.IPv6Address):
        inner = one.ipv4_mapped or one.sixtofour or (one.teredo[1] if one.teredo else None)
        if inner is None and any(one in network for network in TRANSLATED):
            inner = ipaddress.IPv4Address(int(one) & 0xFFFFFFFF)
        if inner is not None:
            return is_public(str(inner))
        if one.is_site_local:  # private before fc00::/7 was, and some networks have it still
            return False
    return one.is_global and not one.is_multicast and not one.is_reserved


def anything(_: str) -> bool:
    return True


def resolved(host: str, port: int) -> list[str]:
    return [str(entry[4][0]) for entry in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)]


def checked_addresses(host: str, port: int, allowed: Allowed, resolve: Resolve = resolved) -> list[str]:
    """The addresses of a host, which may be connected to; a Refused when one of them is not allowed."""
    addresses = list(resolve(host, port))
    for address in addresses:
        if not allowed(address):
            raise Refused(f"{host} is {address}, a private address; allow_private_streams of the simulator allows it")
    return addresses


def fetch(address: str, file: BinaryIO, sizes: StreamSizes, allowed: Allowed) -> int:
    """Fill a file with what is at an address of http or https; returns its bytes.

    Every address is looked at as it is connected to, that of a redirection too. Proxies of the environment are not
    asked: they would look names up themselves. A Refused when the address is none or not allowed, there is too much, or
    there are too many redirections; an OSError or HTTPException when nothing can be had there.
    """
    for _ in range(sizes.redirects + 1):
        parts = urllib.parse.urlsplit(address)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise Refused(f"{address} is no address of http or https")
        connection = _connected(parts, sizes, allowed)
        try:
            path = urllib.parse.urlunsplit(("", "", parts.path or "/", parts.query, ""))
            connection.request("GET", path, headers={"User-Agent": "nao_sim_bridge", "Accept-Encoding": "identity"})
            answer = connection.getresponse()
            if answer.status in REDIRECTS and answer.headers.get("Location"):
                address = urllib.parse.urljoin(address, answer.headers["Location"])
                continue
            if answer.status != http.client.OK:
                raise Refused(f"{answer.status} {answer.reason}")
            return _copy(answer, file, sizes)
        finally:
            connection.close()
    raise Refused(f"it leads on more than {sizes.redirects} times")


def _connected(parts: urllib.parse.SplitResult, sizes: StreamSizes, allowed: Allowed) -> http.client.HTTPConnection:
    secure = parts.scheme == "https"
    port = parts.port or (443 if secure else 80)
    failure: OSError = OSError(f"{parts.hostname} has no address")
    for address in checked_addresses(str(parts.hostname), port, allowed):
        try:
            channel = socket.create_connection((address, port), timeout=sizes.silence_s)
        except OSError as error:
            failure = error
            continue
        if secure:
            channel = ssl.create_default_context().wrap_socket(channel, server_hostname=parts.hostname)
        connection = http.client.HTTPConnection(str(parts.hostname), port)
        connection.default_port = 443 if secure else 80
        connection.sock = channel
        return connection
    raise failure


def _copy(answer: http.client.HTTPResponse, file: BinaryIO, sizes: StreamSizes) -> int:
    size = 0
    while True:
        chunk = answer.read1(CHUNK)
        if not chunk:
            return size
        size += len(chunk)
        if size > sizes.bytes:
            raise Refused(f"it has more than {sizes.bytes} bytes")
        file.write(chunk)


def main(arguments: Iterable[str]) -> int:
    descriptor, memory = arguments
    pipe = pipe_to_parent(descriptor)
    limit_memory(int(memory))
    _, (address, path, sizes, private) = pipe.recv()
    # Whatever becomes of who started this: it ends with its time.
    signal.alarm(math.ceil(sizes.total_s) + 1)
    resource.setrlimit(resource.RLIMIT_FSIZE, (sizes.bytes + CHUNK, sizes.bytes + CHUNK))
    try:
        with open(path, "r+b") as file:
            size = fetch(address, file, sizes, anything if private else is_public)
    except (OSError, ValueError, http.client.HTTPException) as error:
        pipe.send(("error", str(error) or repr(error)))
    except MemoryError:
        pipe.send(("error", f"it needs more memory than the {memory} bytes there are for it"))
    else:
        pipe.send(("fetched", size))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
