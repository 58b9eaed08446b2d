"""The console: pages in a browser for the person who runs a study; a client of servers, topics and services."""
