"""A soak of the stack: two machines, random goals to all servers, accidents, and what must hold all the while."""
