"""ALConnectionManager of the simulated robot. Only NAOqi methods live here; the networks are in `network`."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.arguments import known, map_or_pairs, texts
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.network import EVENTS, TECHNOLOGIES, WIFI, Network

NAME, FILE = "ALConnectionManager", "network.json"


class ALConnectionManager:
    """ALConnectionManager as the simulated robot offers it: of a network that leads nowhere."""

    def __init__(self, memory: MemoryStore) -> None:
        described = read_json(config_file(FILE))
        self._network = Network(described, memory.raise_event)
        self._interfaces, self._countries = described["interfaces"], described["countries"]
        self._country = described["country"]
        for event in EVENTS:
            memory.declare_event(event, NAME)

    def state(self) -> str:
        return self._network.state

    def scan(self, technology: str | None = None) -> None:
        self._network.scan(technology)

    def services(self) -> list[Any]:
        return self._network.infos()

    def service(self, service_id: str) -> list[list[Any]]:
        return self._network.info(service_id)

    def technologies(self) -> list[str]:
        return list(TECHNOLOGIES)

    def interfaces(self) -> list[list[str]]:
        """[[name, MAC address], ...]."""
        return [list(pair) for pair in self._interfaces]

    def connect(self, service_id: str) -> None:
        self._network.connect(service_id)

    def disconnect(self, service_id: str) -> None:
        self._network.disconnect(service_id)

    def forget(self, service_id: str) -> None:
        self._network.forget(service_id)

    def setServiceInput(self, answer: Any) -> None:
        self._network.give_input(map_or_pairs(answer, "input"))

    def setServiceIPv4(self, service_id: str, ipv4: dict[str, str]) -> None:
        self._network.set_ipv4(service_id, ipv4)

    def setServiceDomains(self, service_id: str, domains: list[str]) -> None:
        self._network.set_domains(service_id, domains)

    def setServiceNameservers(self, service_id: str, servers: list[str]) -> None:
        self._network.set_nameservers(service_id, servers)

    def setServiceProxy(self, service_id: str, proxy: dict[str, str]) -> None:
        self._network.set_proxy(service_id, proxy)

    def setServiceConfiguration(self, configuration: Any) -> None:
        """The older way for addresses, domains and name servers: a NetworkInfo."""
        given = map_or_pairs(configuration, "configuration")
        service_id = given.get("ServiceId")
        if not isinstance(service_id, str):
            raise BadValue("configuration", given, 'a NetworkInfo with "ServiceId"')
        self._network.service(service_id)
        if "IPv4" in given:
            self._network.set_ipv4(service_id, map_or_pairs(given["IPv4"], "IPv4"))
        if "Domains" in given:
            self._network.set_domains(service_id, texts(given["Domains"], "Domains"))
        if "Nameserver" in given:
            self._network.set_nameservers(service_id, texts(given["Nameserver"], "Nameserver"))

    def provisionService(self, provision: dict[str, str]) -> None:
        self._network.provision(provision)

    def provisionedServices(self) -> list[dict[str, str]]:
        return self._network.provisioned()

    def removeProvisionedService(self, name: str) -> None:
        self._network.remove_provision(name)

    # --- the robot's own network -------------------------------------------------------------------------------------

    def enableTethering(self, technology: str, *name_and_passphrase: str) -> None:
        _tetherable(technology)
        network = self._network
        given = name_and_passphrase or (network.tethering_name, network.tethering_passphrase)
        if not all(given):
            raise NaoqiError(
                "the network has no name and passphrase yet: enableTethering(technology, name, passphrase)"
            )
        network.tether(*given)

    def disableTethering(self, technology: str) -> None:
        _tetherable(technology)
        if not self._network.tethering:
            raise NaoqiError("the robot is no network: enableTethering makes one")
        self._network.tethering = False

    def getTetheringEnable(self, technology: str) -> bool:
        _tetherable(technology)
        return self._network.tethering

    def tetheringName(self, technology: str) -> str:
        _tetherable(technology)
        return self._network.tethering_name

    def tetheringPassphrase(self, technology: str) -> str:
        _tetherable(technology)
        return self._network.tethering_passphrase

    def countries(self) -> list[str]:
        return list(self._countries)

    def country(self) -> str:
        return self._country

    def setCountry(self, country: str) -> None:
        self._country = known(country, "country", self._countries)


def _tetherable(technology: str) -> None:
    if technology != WIFI:
        raise BadValue("technology", technology, f"{WIFI}, the only one of this robot that can be a network itself")
