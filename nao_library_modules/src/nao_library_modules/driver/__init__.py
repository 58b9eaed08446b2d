"""Driver nodes: topics, services and actions under the names that nao_robot gave them."""
