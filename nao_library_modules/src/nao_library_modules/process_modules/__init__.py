"""Process modules and plans on a NAO: designators, rules, modules, goals and CRAM's plan language."""
